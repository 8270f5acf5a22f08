// "Did you mean" for keys and tables.
#pragma once

#include <keeler/config/schema.hpp>

#include <string>

namespace keeler::config {

/// Returns the nearest name for an unknown path: of a key or table in its table, or else elsewhere; empty if none is
/// near.
std::string suggest_path(const std::string& path, const Schema& schema);

} // namespace keeler::config
