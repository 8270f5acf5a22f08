#include "tables.hpp"

#include <keeler/quantities/views.hpp>

#include <cassert>

namespace keeler {
namespace {

Json settings_of(const Plan& plan, std::size_t point) {
  const std::vector<const GridValue*>& settings = plan.points[point].settings;
  assert(settings.size() == plan.keys.size());
  Json row = Json::object();
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    const GridValue& value = *settings[k];
    const Json number = Json::parse(value.label, nullptr, false);
    row[plan.keys[k]] = value.number && number.is_number() ? number : Json(value.label);
  }
  return row;
}

void add_values(Json& row, const RunQuantities& quantities, const std::vector<std::optional<Estimate>>& values) {
  for (std::size_t k = 0; k < quantities.columns().size(); ++k) {
    const std::optional<Estimate> value = k < values.size() ? values[k] : std::nullopt;
    row[quantities.columns()[k].name] = value ? or_null(value->value) : Json(nullptr);
    row[quantities.columns()[k].error_name] = value ? or_null(value->error) : Json(nullptr);
  }
}

} // namespace

Json runs_as_json(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs) {
  Json rows = Json::array();
  for (const RunRow& run : runs) {
    if (run.status == RunStatus::unfinished)
      continue;
    const RunNumbers numbers = run.numbers.value_or(RunNumbers());
    Json row = row_of(run, settings_of(plan, run.run->point));
    row["particle_count"] = run.numbers ? Json(numbers.particle_count) : Json(nullptr);
    row["since_orbit"] = or_null(numbers.since_orbit);
    row["until_orbit"] = or_null(numbers.until_orbit);
    row["steady"] = run.numbers ? Json(numbers.steady) : Json(nullptr);
    add_values(row, grid.quantities, numbers.values);
    rows.push_back(row);
  }
  return rows;
}

Json points_as_json(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points) {
  Json rows = Json::array();
  for (const PointRow& point : points) {
    if (point.finished == 0)
      continue;
    Json row = settings_of(plan, point.point);
    row["finished_runs"] = point.finished;
    row["failed_runs"] = point.failed;
    row["steady_runs"] = point.steady;
    add_values(row, grid.quantities, point.values);
    rows.push_back(row);
  }
  return rows;
}

} // namespace keeler
