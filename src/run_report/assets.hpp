// Files that the program carries for its pages: see CMakeLists.txt.
#pragma once

#include <string>
#include <string_view>

namespace keeler {

/// The content of "view.js"; nothing when the program was built without it.
std::string_view asset(const std::string& file);

} // namespace keeler
