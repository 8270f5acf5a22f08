// Waves in a ring without self-gravity against the dispersion relation of a viscous fluid. Its viscosity, and how that
// rises with density, are those of the ring without a wave; the bulk viscosity and the slope of the pressure are fitted
// to one wave; the relation then predicts the other. What this tests is how growth and frequency depend on the
// wavelength: an error of the slope of the viscosity would go into the bulk viscosity.
#include "dispersion_relation.hpp"
#include "rows.hpp"
#include "waves.hpp"

#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::validation {
namespace {

constexpr double dense = 1.64, apart = 0.2;                 // optical depths of the slopes are 0.2 above and below
constexpr double pressure_slope_of_steady_ring = 52.6;      // m² Ω²
const std::string thin_layer = "planet.vertical_ratio=3.6"; // for the vertical self-gravity of a dense ring

// A wave in three realisations, since each has noise that grows or decays as the wave does.
struct Waves {
  std::string command;
  Frequencies ring; // κ and ν
  double k = 0.0;   // 1/m
  Estimate growth, frequency;
  std::complex<double> rate() const { return {growth.value, frequency.value}; }
};

Waves waves_of(const WaveStart& start) {
  Waves all;
  std::vector<double> growths, frequencies;
  for (const int seed : {1, 2, 3}) {
    const Wave wave = seeded_wave(start, {thin_layer, fmt::format("particles.seed={}", seed)});
    growths.push_back(wave.growth.rate);
    frequencies.push_back(frequency_of(wave).rate);
    all.command += (seed > 1 ? "; " : "") + wave.command;
    all.ring = wave.patches.front().frequencies;
  }
  all.k = two_pi / start.length;
  all.growth = mean_of(growths);
  all.frequency = mean_of(frequencies);
  return all;
}

// The ring without a wave, in Ω; the slope of the pressure is of runs that log their contacts
// (examples/overstability/README.md).
RingFluid steady_ring() {
  const auto viscosity = [](double optical_depth) {
    const Ran ran =
        run_example("equilibrium", {"box.size=[200,30]", fmt::format("particles.optical_depth={:.2f}", optical_depth),
                                    "time.end=12", "time.step=2e-3", thin_layer});
    return transport_since(ran, 2.0).total->value / ran.snapshots.back().orbital_frequency;
  };
  const double below = viscosity(dense - apart), above = viscosity(dense + apart);
  return {.viscosity = viscosity(dense),
          .flux_slope = (above * (dense + apart) - below * (dense - apart)) / (2.0 * apart),
          .pressure_slope = pressure_slope_of_steady_ring};
}

Row frequency_by_pressure(const Waves& waves, const RingFluid& steady) {
  const double kappa = waves.ring.kappa;
  const double lowest = std::sqrt(kappa * kappa + steady.pressure_slope * waves.k * waves.k),
               highest = std::sqrt(kappa * kappa + 5.0 / 3.0 * steady.pressure_slope * waves.k * waves.k);
  return {.what = "frequency / Omega of the wave of 200 m, nu 3.6, tau 1.64",
          .measured = waves.frequency.value,
          .error = waves.frequency.error,
          .expected = 0.5 * (lowest + highest),
          .tolerance = 0.5 * (highest - lowest) + 2.0 * waves.frequency.error,
          .tolerance_is = "from the pressure of the steady ring to 5/3 of it, and twice the error",
          .source = "omega^2 = kappa^2 + k^2 dP/dSigma (Schmit & Tscharnuter 1995)",
          .command = "of the same runs"};
}

// Growth rate and frequency of a wave, by the fluid that has the waves of 200 m.
std::vector<Row> predicted_rows(const WaveStart& start, const RingFluid& steady, const Waves& fitted) {
  const Waves waves = waves_of(start);
  const auto predicted = [&](std::complex<double> of_fitted) {
    return epicyclic_wave(with_wave(steady, fitted.ring, fitted.k, of_fitted), waves.ring, waves.k);
  };
  const std::complex<double> expected = predicted(fitted.rate());
  const std::complex<double> by_growth = predicted(fitted.rate() + fitted.growth.error) - expected;
  const std::complex<double> by_frequency =
      predicted(fitted.rate() + std::complex<double>(0.0, fitted.frequency.error)) - expected;
  const std::string wave = fmt::format("/ Omega of a wave of {} m, nu 3.6, tau 1.64", start.length);
  const char *tolerance_is = "twice the error of both waves",
             *source = "dispersion relation of a viscous fluid (Schmit & Tscharnuter 1995, Schmidt, Salo, Spahn & "
                       "Petzschmann 2001), with bulk viscosity and pressure from the wave of 200 m";
  return {{.what = "growth rate " + wave,
           .measured = waves.growth.value,
           .error = waves.growth.error,
           .expected = expected.real(),
           .tolerance = 2.0 * std::hypot(waves.growth.error, by_growth.real(), by_frequency.real()),
           .tolerance_is = tolerance_is,
           .source = source,
           .command = waves.command},
          {.what = "frequency " + wave,
           .measured = waves.frequency.value,
           .error = waves.frequency.error,
           .expected = expected.imag(),
           .tolerance = 2.0 * std::hypot(waves.frequency.error, by_growth.imag(), by_frequency.imag()),
           .tolerance_is = tolerance_is,
           .source = source,
           .command = "of the same runs"}};
}

std::vector<Row> waves_of_a_fluid() {
  const RingFluid steady = steady_ring();
  const Waves fitted = waves_of({.amplitude = 0.1, .length = 200.0, .width = 30.0, .depth = dense});
  std::vector<Row> rows = {
      {.what = "growth rate / Omega of a wave of 200 m, nu 3.6, tau 1.64",
       .measured = fitted.growth.value,
       .error = fitted.growth.error,
       .expected = 1.0 / (30.0 * two_pi),
       .tolerance = 0.004,
       .tolerance_is = "the order, and the sign",
       .source = "\"about 30 orbits\" to occur: REBOUND's example of overstability, a set-up of Rein & Latter 2013",
       .command = fitted.command},
      frequency_by_pressure(fitted, steady)};
  for (const Row& row :
       predicted_rows({.amplitude = 0.1, .length = 400.0, .width = 15.0, .depth = dense}, steady, fitted))
    rows.push_back(row);
  // The relation is that of long waves: at 70 m it has a rate of -0.017 and a frequency of 1.24 Ω.
  const Waves damped =
      waves_of({.amplitude = 0.15, .length = 70.0, .width = 172.0, .depth = dense, .since = 1.0, .end = 8.0});
  rows.push_back({.what = "growth rate / Omega of a wave of 70 m, nu 3.6, tau 1.64",
                  .measured = damped.growth.value,
                  .error = damped.growth.error,
                  .expected = -0.02,
                  .tolerance = 0.02,
                  .tolerance_is = "the sign",
                  .source = "short waves are damped (Schmidt, Salo, Spahn & Petzschmann 2001)",
                  .command = damped.command});
  return rows;
}

} // namespace

std::vector<Subject> fluid_wave_subjects() {
  return {{"overstability-relation", "Viscous overstability", false, waves_of_a_fluid}};
}

} // namespace keeler::validation
