// Tables as comma-separated values.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace keeler {

/// Objects of plain values as CSV: the keys of the first as a header, then a line each. Texts with commas, quotes
/// or line breaks are quoted. At least one object.
std::string csv_of(const nlohmann::ordered_json& rows);

/// The same, null as nothing.
std::string csv_with_gaps(nlohmann::ordered_json rows);

} // namespace keeler
