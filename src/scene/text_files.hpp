// Small text files that a scene is made of.
#pragma once

#include <keeler/core/key.hpp>

#include <string>

namespace keeler {

/// The whole file. Throws UsageError "place: FILE cannot be read (why); …" (a scene's fault: exit code 2).
std::string read_text_file(const std::string& path, const std::string& place);

/// The rows that a key asks for, one a line, with blanks, commas or semicolons between the numbers; '#' starts a
/// comment. Throws UsageError with the line of the first fault.
NumberRows read_rows(const std::string& path, const Key& key, const std::string& place);

} // namespace keeler
