// Graphs by gnuplot, when it is installed.
#pragma once

#include <filesystem>
#include <string>

namespace keeler {

/// Writes NAME.gp into the folder and runs it there twice, for NAME.png and NAME.svg. The script sets neither terminal
/// nor output. Returns false when there is no gnuplot; throws IoError when it fails.
bool plot(const std::filesystem::path& folder, const std::string& name, const std::string& script, int width,
          int height);

} // namespace keeler
