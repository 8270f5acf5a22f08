#include <keeler/runs/transport_report.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/viscosity.hpp>
#include <keeler/gravity/fft.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keeler {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Estimate at_an_instant(double value) {
  return {value, std::numeric_limits<double>::quiet_NaN()};
}

void add_viscosity(Json& json, const std::string& name, const std::optional<Estimate>& nu,
                   const ViscosityUnits& units) {
  const auto in = [&](double unit) { return nu ? or_null(nu->value / unit) : Json(nullptr); };
  json[name + "_viscosity_m2_s"] = in(1.0);
  json[name + "_viscosity_error_m2_s"] = nu ? or_null(nu->error) : Json(nullptr);
  json[name + "_viscosity_r2_omega"] = in(units.radii);
  json[name + "_viscosity_g2_sigma2_omega3"] = in(units.gravity);
}

} // namespace

ViscosityUnits::ViscosityUnits(const Patch& patch) {
  const double r = mean_radius(patch), omega = patch.orbital_frequency;
  const double g_sigma = newton_g_si * surface_density(patch);
  radii = r * r * omega;
  gravity = g_sigma * g_sigma / (omega * omega * omega);
}

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

void TransportReport::add_to(Json& json, const Patch& patch) const {
  const ViscosityUnits units(patch);
  const std::optional<Transport>& t = transport_;
  const auto of = [&](const auto& part, bool known) { return t && known ? part(*t) : std::nullopt; };
  const auto add = [&](const char* name, bool known, const auto& part) {
    add_viscosity(json, name, of(part, known), units);
  };
  using Maybe = std::optional<Estimate>;
  add("translational", true, [](const Transport& run) -> Maybe { return run.translational; });
  add("collisional", of_run_, [](const Transport& run) -> Maybe { return run.collisional; });
  add("gravitational", true, [](const Transport& run) -> Maybe { return run.gravitational; });
  add("total", true, [](const Transport& run) -> Maybe { return run.total; });
  add("loss", of_run_, [](const Transport& run) -> Maybe { return run.from_loss; });
  const Maybe balance = t ? t->balance : std::nullopt;
  json["energy_balance"] = balance ? or_null(balance->value) : Json(nullptr);
  json["energy_balance_error"] = balance ? or_null(balance->error) : Json(nullptr);
  json["since_orbit"] = t ? Json(t->since_orbit) : Json(nullptr);
  json["until_orbit"] = t ? Json(t->until_orbit) : Json(nullptr);
  json["since_found"] = t ? Json(t->since_found) : Json(nullptr);
  json["steady"] = t && of_run_ ? Json(t->steady) : Json(nullptr);
  const std::optional<WaveGrowth> waves = t ? t->waves : std::nullopt;
  json["epicyclic_wave_fraction_first_half"] = waves ? or_null(waves->first_half.value) : Json(nullptr);
  json["epicyclic_wave_fraction_last_half"] = waves ? or_null(waves->last_half.value) : Json(nullptr);
  json["epicyclic_waves_steady"] = waves ? Json(waves->steady) : Json(nullptr);
}

} // namespace keeler
