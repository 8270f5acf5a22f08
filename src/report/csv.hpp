// Tables as comma-separated values.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace keeler::report {

/// Returns a list of objects of plain values as CSV: the keys of the first as a header, then one line per object. Texts
/// with commas, quotes or line breaks are quoted. Precondition: `rows` is not empty.
std::string csv_of(const nlohmann::ordered_json& rows);

/// As csv_of(), with empty fields for null.
std::string csv_with_gaps(nlohmann::ordered_json rows);

} // namespace keeler::report
