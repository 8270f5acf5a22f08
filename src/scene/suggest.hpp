// "Did you mean" for keys and tables of scenes.
#pragma once

#include <string>

namespace keeler {

/// What to write for an unknown key path: a key or table near in the same table, or one of that name elsewhere.
std::string suggest_path(const std::string& path);

} // namespace keeler
