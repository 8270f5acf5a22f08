#include <keeler/report/csv.hpp>

#include <keeler/core/json_of_files.hpp>

#include <cassert>

namespace keeler::report {
namespace {

// Returns a field, quoted if necessary (RFC 4180).
std::string field_of(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string(2, c) : std::string(1, c);
  return quoted + "\"";
}

std::string csv_line(const nlohmann::ordered_json& row, bool names) {
  std::string line;
  bool first = true;
  for (const auto& [key, value] : row.items()) {
    const std::string text = names ? key : value.is_string() ? value.get<std::string>() : json_text(value);
    line += (first ? "" : ",") + field_of(text);
    first = false;
  }
  return line + "\n";
}

} // namespace

std::string csv_of(const nlohmann::ordered_json& rows) {
  assert(!rows.empty());
  std::string csv = csv_line(rows.front(), true);
  for (const nlohmann::ordered_json& row : rows)
    csv += csv_line(row, false);
  return csv;
}

std::string csv_with_gaps(nlohmann::ordered_json rows) {
  for (nlohmann::ordered_json& row : rows)
    for (auto& [name, value] : row.items())
      if (value.is_null())
        value = "";
  return csv_of(rows);
}

} // namespace keeler::report
