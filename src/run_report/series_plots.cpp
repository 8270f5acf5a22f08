#include "series_plots.hpp"

#include <keeler/statistics/time_series.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace keeler {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_points = 200; // of a curve

// What a column is drawn as: itself; itself, but it counts from the start, so its mean says nothing; its change an
// orbit; a flux's change as a viscosity.
enum class Drawn { value, total, rate, viscosity };

struct Curve {
  std::string column, name;
  Drawn drawn = Drawn::value;
};

struct Plot {
  std::string title, unit;
  std::vector<Curve> curves;
};

const std::vector<Plot>& known_plots() {
  static const std::vector<Plot> plots = {
      {"Velocity dispersion",
       "m/s",
       {{"dispersion_x_m_s", "radial"},
        {"dispersion_without_waves_x_m_s", "radial, without box-long waves"},
        {"dispersion_y_m_s", "along the orbit"},
        {"dispersion_z_m_s", "vertical"}}},
      {"Viscosity",
       "m²/s",
       {{"translational_flux_kg_m2_s", "translational", Drawn::viscosity},
        {"collisional_flux_kg_m2_s", "collisional", Drawn::viscosity},
        {"gravitational_viscosity_m2_s", "gravitational"}}},
      {"Scale height", "m", {{"scale_height_m", "√⟨z²⟩"}}},
      {"Collisions",
       "an orbit",
       {{"collisions", "faster than v_cut", Drawn::rate}, {"slow_contacts", "slower", Drawn::rate}}},
      {"Energy since the start",
       "J",
       {{"energy_lost_j", "lost in collisions", Drawn::total}, {"kick_work_j", "work of kicks", Drawn::total}}},
      {"Energy of the random motion", "J", {{"random_energy_j", "random motion"}}},
      {"Potential energy of self-gravity", "J, from an arbitrary zero", {{"potential_energy_j", "potential"}}},
      {"Energy that is not booked (rounding)", "J", {{"energy_residual_j", "residual", Drawn::total}}},
      {"Translational viscosity at an instant", "m²/s", {{"translational_viscosity_m2_s", "⟨c_x c_y⟩/S"}}},
      {"Fraction of the epicyclic energy in box-long waves", "", {{"epicyclic_wave_fraction", "axisymmetric waves"}}},
      {"Spins", "Ω", {{"mean_spin_omega", "mean"}, {"spin_dispersion_omega", "dispersion"}}},
      {"Energy of the spins over that of the random motion", "", {{"spin_energy_ratio", "ratio"}}},
      {"Energy of the spins", "J", {{"spin_energy_j", "spins"}}},
      {"Automatic step", "orbits", {{"step_orbits", "step"}, {"kick_interval_orbits", "from kick to kick"}}},
      {"Largest overlap of a pair", "radius sums", {{"largest_overlap", "overlap"}}}};
  return plots;
}

// Columns without a plot above have one by their own names.
std::vector<Plot> plots_of(const SeriesTable& series) {
  std::vector<Plot> plots = known_plots();
  std::set<std::string> seen = {"step", "time_orbits"};
  for (const Plot& plot : plots)
    for (const Curve& curve : plot.curves)
      seen.insert(curve.column);
  for (const std::string& name : series.names)
    if (!seen.contains(name))
      plots.push_back({name, "", {{name, name}}});
  return plots;
}

struct Points {
  std::vector<double> times, values;
};

// What is not known (nan) is left out.
Points points_of(const SeriesTable& series, const Curve& curve, const RingScale& scale) {
  const std::vector<double>&times = series.of("time_orbits"), &column = series.of(curve.column);
  const double orbit_s = 2.0 * std::numbers::pi / scale.orbital_frequency;
  const double unit =
      curve.drawn == Drawn::viscosity ? orbit_s * scale.mass * scale.shear * scale.orbital_frequency : 1.0;
  Points points;
  const bool itself = curve.drawn == Drawn::value || curve.drawn == Drawn::total;
  for (std::size_t k = itself ? 0 : 1; k < column.size(); ++k) {
    const double time = itself ? times[k] : 0.5 * (times[k - 1] + times[k]);
    const double value = itself ? column[k] : (column[k] - column[k - 1]) / ((times[k] - times[k - 1]) * unit);
    if (std::isfinite(value)) {
      points.times.push_back(time);
      points.values.push_back(value);
    }
  }
  return points;
}

Json or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

// [time, mean, standard error of the mean or null] of rows that follow each other.
Json binned(const Points& points) {
  const std::size_t bins = std::min(most_points, points.times.size());
  Json all = Json::array();
  for (std::size_t b = 0; b < bins; ++b) {
    const std::size_t from = b * points.times.size() / bins, to = (b + 1) * points.times.size() / bins;
    const auto n = static_cast<double>(to - from);
    double time = 0.0, mean = 0.0, squares = 0.0;
    for (std::size_t k = from; k < to; ++k) {
      time += points.times[k] / n;
      mean += points.values[k] / n;
    }
    for (std::size_t k = from; k < to; ++k)
      squares += (points.values[k] - mean) * (points.values[k] - mean);
    const double error = n > 1.0 ? std::sqrt(squares / (n - 1.0) / n) : std::numeric_limits<double>::quiet_NaN();
    all.push_back({time, mean, or_null(error)});
  }
  return all;
}

Json numbers_of_estimate(const Estimate& mean) {
  return {{"value", or_null(mean.value)}, {"error", or_null(mean.error)}};
}

// A viscosity is the one of the tables; of anything else the mean of the rows in the window, null where there are none.
Json steady_mean(const Curve& curve, const Points& points, const Transport& steady) {
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
  return values.empty() || curve.drawn == Drawn::total ? Json(nullptr) : numbers_of_estimate(block_mean(values));
}

} // namespace

std::optional<Transport> steady_part(const TransportReport& report) {
  const std::optional<Transport>& found = report.transport();
  return found && found->since_found ? found : std::nullopt;
}

Json series_plots(const SeriesTable& series, const RingScale& scale, const std::optional<Transport>& steady) {
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

} // namespace keeler
