#include <keeler/runs/transport_report.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/viscosity.hpp>
#include <keeler/gravity/fft.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keeler {
namespace {

Estimate at_an_instant(double value) {
  return {value, std::numeric_limits<double>::quiet_NaN()};
}

} // namespace

std::string words_of(const WaveGrowth& waves) {
  const auto fraction = [](const Estimate& half) { return fmt::format("{:.2g}", std::max(0.0, half.value)); };
  return fmt::format("{} of the epicyclic energy in the first half of these orbits, {} in the last{}",
                     fraction(waves.first_half), fraction(waves.last_half),
                     waves.steady ? ""
                                  : ": not steady, so Q and c_x with them depend on the age of the run and on its box");
}

TransportReport TransportReport::of_run(const std::filesystem::path& folder, const RingScale& scale,
                                        const OrbitWindow& window) {
  TransportReport report;
  report.of_run_ = true;
  const std::filesystem::path file = folder / "series.csv";
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown))
    return report;
  const SeriesTable series = read_series(file);
  if (!enough_rows(series))
    return report;
  try {
    report.transport_ = keeler::transport(series, scale, window);
  } catch (const UsageError&) { // too few rows in the window: its snapshots may be enough for the rest
  }
  return report;
}

TransportReport TransportReport::of_snapshot(const Patch& patch, const std::optional<GravitySettings>& gravity) {
  TransportReport report;
  Transport& t = report.transport_.emplace();
  const double omega = patch.orbital_frequency;
  t.since_orbit = t.until_orbit = patch.time_orbits;
  t.translational = at_an_instant(translational_viscosity(patch) * omega);
  if (gravity && has_energy_meter(*gravity)) {
    const auto meter = make_energy_meter(*gravity, patch.masses, patch.box.area());
    const GravityProblem problem{patch.positions, patch.masses, patch.ids, patch.box, patch.offset, newton_g(omega)};
    t.gravitational = at_an_instant(meter->energy(problem).stress / (total_mass(patch) * patch.box.shear) * omega);
  }
  return report;
}

} // namespace keeler
