// What sweeps and studies measure in each finished run. Each number is declared once, with its unit and meaning: the
// columns of their tables, the choice of a sweep's plot and the table in docs/formats.md come from here.
#pragma once

#include <keeler/scene/scene.hpp>
#include <keeler/statistics/time_series.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// NAME_UNIT in the tables, its error NAME_error_UNIT, as `keeler analyze` names them; a unit may be none.
struct QuantityName {
  std::string name, unit, meaning;

  std::string column() const { return unit.empty() ? name : name + "_" + unit; }
  std::string error_column() const { return unit.empty() ? name + "_error" : name + "_error_" + unit; }
};

/// In the order of the tables' columns.
const std::vector<QuantityName>& quantities();

/// Their columns.
std::vector<std::string> quantity_names();

struct RunNumbers {
  std::size_t particle_count = 0;
  std::optional<double> since_orbit, until_orbit; ///< none: the series is too short for a mean
  bool steady = false;
  std::vector<std::optional<Estimate>> values; ///< in the order of quantities(); none: not measured. Error NaN: unknown
};

/// Of a finished run: means over its rows from orbit `since` on, or over the part that is steady. Throws IoError.
RunNumbers measure_run(const std::filesystem::path& folder, const Scene& scene, std::optional<double> since);

} // namespace keeler
