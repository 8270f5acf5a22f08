#include <keeler/report/csv.hpp>

namespace keeler {
namespace {

std::string csv_line(const nlohmann::ordered_json& row, bool names) {
  std::string line;
  for (const auto& [key, value] : row.items())
    line += (line.empty() ? "" : ",") + (names ? key : value.is_string() ? value.get<std::string>() : value.dump());
  return line + "\n";
}

} // namespace

std::string csv_of(const nlohmann::ordered_json& rows) {
  std::string csv = csv_line(rows.front(), true);
  for (const nlohmann::ordered_json& row : rows)
    csv += csv_line(row, false);
  return csv;
}

} // namespace keeler
