#include "series_plots.hpp"

#include <keeler/quantities/views.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/statistics/scatter.hpp>
#include <keeler/statistics/time_series.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <set>

namespace keeler::run_report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_points = 200; // per curve

// A column and how it is drawn.
struct Drawn {
  std::string column, title, name;
  quantities::Unit unit; // in SI: sums are drawn as they are, events per orbit, fluxes as viscosities
  runs::ColumnKind kind = runs::ColumnKind::value;
};

quantities::Unit drawn_unit(const runs::SeriesColumn& column) {
  namespace unit = quantities::unit;
  const std::string_view text = column.unit;
  return column.kind == runs::ColumnKind::count                                  ? unit::unnamed("per orbit")
         : column.kind == runs::ColumnKind::flux || text == unit::viscosity.text ? unit::viscosity
         : text == unit::metres_per_second.text                                  ? unit::metres_per_second
                                                : unit::unnamed(text == "1" ? "" : text);
}

// Returns what is drawn of a series. Columns unknown to this program have plots titled with their names.
std::vector<Drawn> drawn_columns(const io::SeriesTable& series) {
  std::vector<Drawn> all;
  std::set<std::string> known = {"step", "time_orbits"};
  for (const runs::SeriesColumn& column : runs::series_columns()) {
    const std::string plot = column.plot;
    const std::size_t colon = plot.find(": ");
    if (known.insert(column.name).second)
      all.push_back({column.name, plot.substr(0, colon), plot.substr(colon + 2), drawn_unit(column), column.kind});
  }
  for (const std::string& name : series.names)
    if (!known.contains(name))
      all.push_back({name, name, name, {}});
  return all;
}

struct Points {
  std::vector<double> times, values;
};

// Returns the points of a curve; unknown values (NaN) are omitted.
Points points_of(const io::SeriesTable& series, const Drawn& curve, const runs::RingScale& scale) {
  const std::vector<double>&times = series.of("time_orbits"), &column = series.of(curve.column);
  const double orbit_s = 2.0 * std::numbers::pi / scale.orbital_frequency;
  const double unit =
      curve.kind == runs::ColumnKind::flux ? orbit_s * scale.mass * scale.shear * scale.orbital_frequency : 1.0;
  assert(column.size() == times.size());
  Points points;
  const bool instantaneous = curve.kind == runs::ColumnKind::value || curve.kind == runs::ColumnKind::sum;
  for (std::size_t k = instantaneous ? 0 : 1; k < column.size(); ++k) {
    const double time = instantaneous ? times[k] : 0.5 * (times[k - 1] + times[k]);
    const double value = instantaneous ? column[k] : (column[k] - column[k - 1]) / ((times[k] - times[k - 1]) * unit);
    if (std::isfinite(value)) {
      points.times.push_back(time);
      points.values.push_back(value);
    }
  }
  return points;
}

// Returns means over bins of consecutive rows.
std::vector<SeriesPoint> binned(const Points& points) {
  assert(points.times.size() == points.values.size());
  const std::size_t bins = std::min(max_points, points.times.size());
  std::vector<SeriesPoint> all;
  for (std::size_t b = 0; b < bins; ++b) {
    const std::size_t from = b * points.times.size() / bins, to = (b + 1) * points.times.size() / bins;
    const auto part = [&](const std::vector<double>& all_of) {
      const auto begin = all_of.begin();
      return statistics::scatter_of(
          {begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to)});
    };
    const statistics::Scatter values = part(points.values);
    const double error = values.mean_error();
    all.push_back({part(points.times).mean, values.mean, std::isfinite(error) ? std::optional(error) : std::nullopt});
  }
  return all;
}

// Returns the mean over the steady part: for viscosities the value of the tables, otherwise the mean of the rows; none
// if there are none.
std::optional<Estimate> steady_mean(const Drawn& curve, const Points& points, const runs::Transport& steady) {
  if (curve.column == "translational_flux_kg_m2_s")
    return steady.translational;
  if (curve.column == "collisional_flux_kg_m2_s")
    return steady.collisional;
  if (curve.column == "gravitational_viscosity_m2_s")
    return steady.gravitational;
  std::vector<double> values;
  for (std::size_t k = 0; k < points.times.size(); ++k)
    if (points.times[k] >= steady.since_orbit && points.times[k] <= steady.until_orbit)
      values.push_back(points.values[k]);
  return values.empty() || curve.kind == runs::ColumnKind::sum ? std::nullopt
                                                               : std::optional(statistics::block_mean(values));
}

void divide(SeriesCurve& curve, double size) {
  for (SeriesPoint& point : curve.points) {
    point.value /= size;
    if (point.error)
      *point.error /= size;
  }
  if (curve.mean)
    *curve.mean = {curve.mean->value / size, curve.mean->error / size};
}

// Returns a number of a record, of a vector the component along the axis.
std::optional<double> plain_number(const quantities::Record& record, const quantities::Quantity& of, std::size_t axis) {
  const quantities::Value* const value = find_value(record, of.name);
  const auto* const vector = value ? std::get_if<std::vector<double>>(value) : nullptr;
  return vector ? std::optional((*vector)[axis]) : number_in(record, of.name);
}

} // namespace

std::optional<runs::Transport> steady_part(const runs::TransportReport& report) {
  const std::optional<runs::Transport>& found = report.transport();
  return found && found->since_found ? found : std::nullopt;
}

SeriesPlots series_plots(const io::SeriesTable& series, const runs::RingScale& scale,
                         const std::optional<runs::Transport>& steady, const DrawnUnits& units) {
  SeriesPlots all{steady, {}};
  for (const Drawn& column : drawn_columns(series)) {
    const Points points = series.find(column.column) ? points_of(series, column, scale) : Points();
    if (points.times.empty())
      continue;
    SeriesCurve curve{column.name, binned(points), steady ? steady_mean(column, points, *steady) : std::nullopt};
    divide(curve, size_of_unit(column.unit, units.system, units.patch));
    const auto same = std::find_if(all.plots.begin(), all.plots.end(),
                                   [&](const SeriesPlot& plot) { return plot.title == column.title; });
    SeriesPlot& plot = same != all.plots.end()
                           ? *same
                           : all.plots.emplace_back(
                                 SeriesPlot{column.title, std::string(unit_in(column.unit, units.system).text), {}});
    plot.curves.push_back(std::move(curve));
  }
  return all;
}

std::vector<SeriesPlot> number_curves(std::span<const quantities::Record> records, const DrawnUnits& units) {
  std::vector<SeriesPlot> all;
  if (records.empty())
    return all;
  for (const quantities::Quantity& of : quantities_of(records.front()))
    for (std::size_t axis = 0; axis < (of.shape == quantities::Shape::vector ? 3 : 1); ++axis) {
      const quantities::Quantity one = of.shape == quantities::Shape::vector ? of.along(axis) : of;
      SeriesCurve curve{"", {}};
      for (const quantities::Record& record : records)
        if (const std::optional<double> value = plain_number(record, of, axis); value && std::isfinite(*value))
          curve.points.push_back({number_in(record, "time").value(), *value, std::nullopt});
      divide(curve, size_of_unit(one.unit, units.system, units.patch));
      if (!curve.points.empty())
        all.push_back({one.full_name(units.system), std::string(unit_in(one.unit, units.system).text), {curve}});
    }
  return all;
}

Json json_of(const SeriesPlots& plots, std::span<const SeriesPlot> snapshots) {
  using quantities::or_null;
  const auto list_of = [](std::span<const SeriesPlot> some) {
    Json list = Json::array();
    for (const SeriesPlot& plot : some) {
      Json curves = Json::array();
      for (const SeriesCurve& curve : plot.curves) {
        Json points = Json::array(), mean = nullptr;
        for (const SeriesPoint& point : curve.points)
          points.push_back({point.orbits, point.value, or_null(point.error)});
        if (curve.mean)
          mean = {{"value", or_null(curve.mean->value)}, {"error", or_null(curve.mean->error)}};
        curves.push_back({{"name", curve.name}, {"points", points}, {"mean", mean}});
      }
      list.push_back({{"title", plot.title}, {"unit", plot.unit}, {"curves", curves}});
    }
    return list;
  };
  Json steady = nullptr;
  if (plots.steady)
    steady = {plots.steady->since_orbit, plots.steady->until_orbit};
  return {{"steady", steady}, {"plots", list_of(plots.plots)}, {"snapshots", list_of(snapshots)}};
}

} // namespace keeler::run_report
