#include <keeler/runs/transport_report.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/viscosity.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace keeler::runs {
namespace {

Estimate at_an_instant(double value) {
  return {value, std::numeric_limits<double>::quiet_NaN()};
}

namespace unit = quantities::unit;
using quantities::Forms, quantities::Quantity, quantities::QuantityRow, quantities::Record, quantities::Spread,
    quantities::Unknown, quantities::Value, quantities::of_digits, quantities::value_of, quantities::yes_or_no;
using Report = const TransportReport&;
using Maybe = std::optional<Estimate>;

// Returns a number of the transport; unknown if the series has too few rows.
Value of_transport(Report r, const std::function<Value(const Transport&)>& number) {
  return r.transport() ? number(*r.transport())
                       : Unknown{"series.csv has fewer than three rows with all stresses here"};
}

// As above, for numbers that a single snapshot does not have.
Value of_run(Report r, const std::function<Value(const Transport&)>& number) {
  return r.is_of_run() ? of_transport(r, number) : Unknown{"a single snapshot does not determine it"};
}

Quantity viscosity(const char* part, const char* label, const char* meaning) {
  return {fmt::format("{}_viscosity", part), unit::viscosity, label, meaning, Spread::error, Forms::all};
}

std::vector<QuantityRow<TransportReport>> transport_rows() {
  return {
      {viscosity("translational", "viscosity: translational",
                 "⟨c_x c_y⟩/S: transport by the motion of particles (local; Wisdom & Tremaine 1988, AJ 95, 925)"),
       [](Report r) { return of_transport(r, [](const Transport& t) { return value_of(Maybe(t.translational)); }); }},
      {viscosity("collisional", "viscosity: collisional",
                 "Σ (x_j − x_i) (p_y gained by j) per time over M S: transport from centre to centre in contacts "
                 "(nonlocal; Wisdom & Tremaine 1988)"),
       [](Report r) { return of_run(r, [](const Transport& t) { return value_of(Maybe(t.collisional)); }); }},
      {viscosity("gravitational", "viscosity: gravitational",
                 "(dΦ/dγ)/(M S): transport by self-gravity (Daisaka, Tanaka & Ida 2001, Icarus 154, 296)"),
       [](Report r) { return of_transport(r, [](const Transport& t) { return value_of(t.gravitational); }); }},
      {viscosity("total", "viscosity: total", "the sum of the three, with the error of the sum"),
       [](Report r) { return of_run(r, [](const Transport& t) { return value_of(t.total); }); }},
      {viscosity("loss", "viscosity: from the loss",
                 "(energy lost in collisions + gain of random and potential energy) per time over M S²: must equal "
                 "the total"),
       [](Report r) { return of_run(r, [](const Transport& t) { return value_of(Maybe(t.from_loss)); }); }},
      {{"energy_balance", unit::none, "energy balance",
        "`loss_viscosity` over `total_viscosity`: 1 within its error; null where another force does work",
        Spread::error},
       [](Report r) { return of_run(r, [](const Transport& t) { return value_of(t.balance); }); }},
      {{"since_orbit", unit::unnamed("orbits"), "viscosities: since", "first orbit of the measured part"},
       [](Report r) { return of_transport(r, [](const Transport& t) { return t.since_orbit; }); }},
      {{"until_orbit", unit::unnamed("orbits"), "viscosities: until", "last orbit of the measured part"},
       [](Report r) { return of_transport(r, [](const Transport& t) { return t.until_orbit; }); }},
      {yes_or_no("since_found", "",
                 "whether its beginning was detected, by Chodera's criterion (2016, J. Chem. Theory Comput. 12, 1799)"),
       [](Report r) { return of_transport(r, [](const Transport& t) { return t.since_found; }); }},
      {yes_or_no("steady", "viscosities: steady", "whether loss and dispersion are steady in that part"),
       [](Report r) { return of_run(r, [](const Transport& t) { return t.steady; }); }},
      {of_digits(2, {"epicyclic_wave_fraction_first_half", unit::none, "box-long waves: first half",
                     "mean of the series' `epicyclic_wave_fraction` over the first half of that part"}),
       [](Report r) {
         return of_transport(
             r, [](const Transport& t) { return t.waves ? value_of(t.waves->first_half.value) : Unknown{}; });
       }},
      {of_digits(2, {"epicyclic_wave_fraction_last_half", unit::none, "box-long waves: last half",
                     "mean of it over the last half"}),
       [](Report r) {
         return of_transport(
             r, [](const Transport& t) { return t.waves ? value_of(t.waves->last_half.value) : Unknown{}; });
       }},
      {yes_or_no(
           "epicyclic_waves_steady", "box-long waves: steady",
           "whether the two agree within three errors; if not, Q and c_x depend on the age of the run and on its box"),
       [](Report r) {
         return of_transport(r, [](const Transport& t) { return t.waves ? Value(t.waves->steady) : Value(Unknown{}); });
       }}};
}

} // namespace

std::string describe(const WaveGrowth& waves) {
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
  return of_series(io::read_series(file), scale, window);
}

TransportReport TransportReport::of_series(const io::SeriesTable& series, const RingScale& scale,
                                           const OrbitWindow& window) {
  TransportReport report;
  report.of_run_ = true;
  if (!enough_rows(series))
    return report;
  try {
    report.transport_ = runs::transport(series, scale, window);
  } catch (const UsageError&) { // too few rows in the window; its snapshots may suffice for the other quantities
  }
  return report;
}

TransportReport TransportReport::of_snapshot(const Patch& patch, const std::optional<GravitySettings>& gravity) {
  TransportReport report;
  Transport& t = report.transport_.emplace();
  const double omega = patch.orbital_frequency;
  assert(omega > 0.0);
  t.since_orbit = t.until_orbit = patch.time_orbits;
  t.translational = at_an_instant(diagnostics::translational_viscosity(patch) * omega);
  if (gravity && has_energy_meter(*gravity)) {
    const auto meter = make_energy_meter(*gravity, patch.masses, patch.box.area());
    const gravity::GravityProblem problem{patch.positions, patch.masses, patch.ids,
                                          patch.box,       patch.offset, newton_g(omega)};
    t.gravitational =
        at_an_instant(meter->energy(problem).stress / (diagnostics::total_mass(patch) * patch.box.shear) * omega);
  }
  return report;
}

Record record_of(const TransportReport& transport, const quantities::PatchUnits& units) {
  static const std::vector<QuantityRow<TransportReport>> rows = transport_rows();
  return {entries_of(rows, transport), units};
}

std::vector<Quantity> transport_quantities() {
  return quantities_of(transport_rows());
}

} // namespace keeler::runs
