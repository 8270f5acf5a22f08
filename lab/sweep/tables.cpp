#include "tables.hpp"

#include <keeler/quantities/views.hpp>

#include <cassert>

namespace keeler::sweep {
namespace {

batch::Json settings_of(const Plan& plan, std::size_t point) {
  const std::vector<const GridValue*>& settings = plan.points[point].settings;
  assert(settings.size() == plan.keys.size());
  batch::Json row = batch::Json::object();
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    const GridValue& value = *settings[k];
    const batch::Json number = batch::Json::parse(value.label, nullptr, false);
    row[plan.keys[k]] = value.number && number.is_number() ? number : batch::Json(value.label);
  }
  return row;
}

void add_values(batch::Json& row, const batch::RunQuantities& quantities,
                const std::vector<std::optional<Estimate>>& values) {
  for (std::size_t k = 0; k < quantities.columns().size(); ++k) {
    const std::optional<Estimate> value = k < values.size() ? values[k] : std::nullopt;
    row[quantities.columns()[k].name] = value ? quantities::or_null(value->value) : batch::Json(nullptr);
    row[quantities.columns()[k].error_name] = value ? quantities::or_null(value->error) : batch::Json(nullptr);
  }
}

} // namespace

batch::Json runs_as_json(const Grid& grid, const Plan& plan, const std::vector<batch::RunRow>& runs) {
  batch::Json rows = batch::Json::array();
  for (const batch::RunRow& run : runs) {
    if (run.status == batch::RunStatus::unfinished)
      continue;
    const batch::RunNumbers numbers = run.numbers.value_or(batch::RunNumbers());
    batch::Json row = row_of(run, settings_of(plan, run.run->point));
    row["particle_count"] = run.numbers ? batch::Json(numbers.particle_count) : batch::Json(nullptr);
    row["since_orbit"] = quantities::or_null(numbers.since_orbit);
    row["until_orbit"] = quantities::or_null(numbers.until_orbit);
    row["steady"] = run.numbers ? batch::Json(numbers.steady) : batch::Json(nullptr);
    add_values(row, grid.quantities, numbers.values);
    rows.push_back(row);
  }
  return rows;
}

batch::Json points_as_json(const Grid& grid, const Plan& plan, const std::vector<batch::PointRow>& points) {
  batch::Json rows = batch::Json::array();
  for (const batch::PointRow& point : points) {
    if (point.finished == 0)
      continue;
    batch::Json row = settings_of(plan, point.point);
    row["finished_runs"] = point.finished;
    row["failed_runs"] = point.failed;
    row["steady_runs"] = point.steady;
    add_values(row, grid.quantities, point.values);
    rows.push_back(row);
  }
  return rows;
}

} // namespace keeler::sweep
