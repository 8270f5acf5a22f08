// Returns a number of a measurement by its key. Throws nlohmann::json::exception when it is missing.
#pragma once

#include "job_list.hpp"

#include <string>

namespace keeler {

inline double of(const Json& json, const std::string& key) {
  return json.at(key).get<double>();
}

} // namespace keeler
