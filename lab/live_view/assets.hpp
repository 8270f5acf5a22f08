// Files of the live page that are embedded in the program: see CMakeLists.txt.
#pragma once

#include <string>
#include <string_view>

namespace keeler::live_view {

/// Returns the content of an embedded file, as "live.js".
std::string_view asset(const std::string& file);

} // namespace keeler::live_view
