// Graphs by gnuplot, when it is installed.
#pragma once

#include <filesystem>
#include <string>

namespace keeler {

/// A text as a string of a script, in single quotes. Whatever words of others it repeats, it ends where the string does
/// and no part of it is a command: line breaks and other control characters become '?'.
std::string gnuplot_string(const std::string& text);

/// Writes NAME.gp into the folder and runs it there twice, for NAME.png and NAME.svg. The script sets neither terminal
/// nor output. What gnuplot says goes nowhere. Returns false when there is no gnuplot; throws IoError when it fails.
bool plot(const std::filesystem::path& folder, const std::string& name, const std::string& script, int width,
          int height);

} // namespace keeler
