// Graphs by gnuplot, if it is installed.
#pragma once

#include <filesystem>
#include <string>

namespace keeler {

/// Returns a text as a single-quoted string of a script. Untrusted text is safe: quotes are doubled, and line breaks
/// and other control characters become '?', so no part of it is a command.
std::string gnuplot_string(const std::string& text);

/// Writes NAME.gp into the folder and runs it there twice, for NAME.png and NAME.svg. Precondition: the script sets
/// neither terminal nor output. The messages of gnuplot are discarded. Returns false if gnuplot is not installed;
/// throws IoError when it fails.
bool plot(const std::filesystem::path& folder, const std::string& name, const std::string& script, int width,
          int height);

} // namespace keeler
