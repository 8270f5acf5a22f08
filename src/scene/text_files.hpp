// Small text files that a scene is made of.
#pragma once

#include <string>
#include <vector>

namespace keeler {

/// The whole file. Throws UsageError "place: FILE cannot be read (why); …" (a scene's fault: exit code 2).
std::string read_text_file(const std::string& path, const std::string& place);

/// Radii (m), one a line; '#' starts a comment. Throws UsageError with the line of the first fault.
std::vector<double> read_radii(const std::string& path, const std::string& place);

} // namespace keeler
