// Files for the pages that are embedded in the program: see CMakeLists.txt.
#pragma once

#include <string>
#include <string_view>

namespace keeler::run_report {

/// Returns the content of an embedded file, as "view.js"; empty if the program was built without it.
std::string_view asset(const std::string& file);

} // namespace keeler::run_report
