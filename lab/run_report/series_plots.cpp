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
#include <string>
#include <vector>

namespace keeler::run_report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_points = 200; // per curve

struct Curve {
  std::string column, name;
  runs::ColumnKind kind = runs::ColumnKind::value;
};

struct Plot {
  std::string title, unit;
  std::vector<Curve> curves;
};

// Returns the unit of a curve: sums are drawn as they are, events per orbit, fluxes as viscosities.
std::string drawn_unit(const runs::SeriesColumn& column) {
  const std::string unit = column.unit;
  return column.kind == runs::ColumnKind::count  ? "per orbit"
         : column.kind == runs::ColumnKind::flux ? "m²/s"
         : unit == "1"                           ? ""
                                                 : unit;
}

// Returns the plots of a series. Columns unknown to this program have plots titled with their names.
std::vector<Plot> plots_of(const io::SeriesTable& series) {
  std::vector<Plot> plots;
  const auto curve_of = [&](const std::string& title, const std::string& unit, const Curve& curve) {
    const auto same = std::find_if(plots.begin(), plots.end(), [&](const Plot& plot) { return plot.title == title; });
    if (same != plots.end())
      same->curves.push_back(curve);
    else
      plots.push_back({title, unit, {curve}});
  };
  std::set<std::string> known = {"step", "time_orbits"};
  for (const runs::SeriesColumn& column : runs::series_columns()) {
    const std::string plot = column.plot;
    const std::size_t colon = plot.find(": ");
    if (known.insert(column.name).second)
      curve_of(plot.substr(0, colon), drawn_unit(column), {column.name, plot.substr(colon + 2), column.kind});
  }
  for (const std::string& name : series.names)
    if (!known.contains(name))
      curve_of(name, "", {name, name});
  return plots;
}

struct Points {
  std::vector<double> times, values;
};

// Returns the points of a curve; unknown values (NaN) are omitted.
Points points_of(const io::SeriesTable& series, const Curve& curve, const runs::RingScale& scale) {
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

// Returns bins of consecutive rows: [time, mean, standard error of the mean or null].
Json binned(const Points& points) {
  assert(points.times.size() == points.values.size());
  const std::size_t bins = std::min(max_points, points.times.size());
  Json all = Json::array();
  for (std::size_t b = 0; b < bins; ++b) {
    const std::size_t from = b * points.times.size() / bins, to = (b + 1) * points.times.size() / bins;
    const auto part = [&](const std::vector<double>& all_of) {
      const auto begin = all_of.begin();
      return statistics::scatter_of(
          {begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to)});
    };
    const statistics::Scatter values = part(points.values);
    all.push_back({part(points.times).mean, values.mean, quantities::or_null(values.mean_error())});
  }
  return all;
}

Json numbers_of_estimate(const Estimate& mean) {
  return {{"value", quantities::or_null(mean.value)}, {"error", quantities::or_null(mean.error)}};
}

// Returns the mean over the steady part: for viscosities the value of the tables, otherwise the mean of the rows; null
// if there are none.
Json steady_mean(const Curve& curve, const Points& points, const runs::Transport& steady) {
  if (curve.column == "translational_flux_kg_m2_s")
    return numbers_of_estimate(steady.translational);
  if (curve.column == "collisional_flux_kg_m2_s")
    return numbers_of_estimate(steady.collisional);
  if (curve.column == "gravitational_viscosity_m2_s")
    return steady.gravitational ? numbers_of_estimate(*steady.gravitational) : Json(nullptr);
  std::vector<double> values;
  for (std::size_t k = 0; k < points.times.size(); ++k)
    if (points.times[k] >= steady.since_orbit && points.times[k] <= steady.until_orbit)
      values.push_back(points.values[k]);
  return values.empty() || curve.kind == runs::ColumnKind::sum ? Json(nullptr)
                                                               : numbers_of_estimate(statistics::block_mean(values));
}

} // namespace

std::optional<runs::Transport> steady_part(const runs::TransportReport& report) {
  const std::optional<runs::Transport>& found = report.transport();
  return found && found->since_found ? found : std::nullopt;
}

Json series_plots(const io::SeriesTable& series, const runs::RingScale& scale,
                  const std::optional<runs::Transport>& steady) {
  Json all = {{"steady", nullptr}, {"plots", Json::array()}};
  if (steady)
    all["steady"] = {steady->since_orbit, steady->until_orbit};
  for (const Plot& plot : plots_of(series)) {
    Json json = {{"title", plot.title}, {"unit", plot.unit}, {"curves", Json::array()}};
    for (const Curve& curve : plot.curves) {
      if (series.find(curve.column) == nullptr)
        continue;
      const Points points = points_of(series, curve, scale);
      if (points.times.empty())
        continue;
      json["curves"].push_back({{"name", curve.name},
                                {"points", binned(points)},
                                {"mean", steady ? steady_mean(curve, points, *steady) : Json(nullptr)}});
    }
    if (!json["curves"].empty())
      all["plots"].push_back(json);
  }
  return all;
}

} // namespace keeler::run_report
