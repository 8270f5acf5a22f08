// Viscous overstability: waves that are seeded, and grow or decay; without self-gravity, and with it and its wakes.
#include "rows.hpp"
#include "waves.hpp"

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/wake_geometry.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::validation {
namespace {

// ν/Ω = 3.6 stands for the vertical self-gravity of a dense ring.
Wave without_gravity(double length) {
  return seeded_wave({.length = length, .width = std::round(12000.0 / length), .depth = 0.5},
                     {"planet.vertical_ratio=3.6"});
}

Wave with_gravity(double hill, double orbits, const std::vector<std::string>& more = {}) {
  constexpr double omega = 1.95e-4; // of the example
  const double density = 9.0 * omega * omega * hill * hill * hill / (pi * newton_g_si);
  std::vector<std::string> all = {fmt::format("particles.density={:.1f}", density), "gravity={solver=\"fft\"}",
                                  "collisions.restitution={ law = \"constant\", value = 0.1 }"};
  all.insert(all.end(), more.begin(), more.end());
  return seeded_wave({.amplitude = 0.1, .length = 100.0, .width = 60.0, .depth = 1.0, .end = orbits}, all);
}

Row growth_row(const std::string& wave_of, const Wave& wave, double expected, double tolerance,
               const char* tolerance_is, const char* source) {
  return {.what = fmt::format("growth rate / Omega of a wave of {}", wave_of),
          .measured = wave.growth.rate,
          .error = *wave.growth.error,
          .expected = expected,
          .tolerance = tolerance,
          .tolerance_is = tolerance_is,
          .source = source,
          .command = wave.command};
}

Row ratio_row(const char* what, const Wave& wave, const Wave& other, double expected, double tolerance,
              const char* tolerance_is) {
  const double ratio = wave.growth.rate / other.growth.rate,
               error = std::fabs(ratio) *
                       std::hypot(*wave.growth.error / wave.growth.rate, *other.growth.error / other.growth.rate);
  return {.what = what,
          .measured = ratio,
          .error = error,
          .expected = expected,
          .tolerance = tolerance + 2.0 * error,
          .tolerance_is = fmt::format("{}, and twice the error", tolerance_is),
          .source = "k^2, of long waves in a viscous fluid (Schmit & Tscharnuter 1995)",
          .command = "of the same runs"};
}

// The part of a thin sheet's gravity that a layer of finite thickness has in a wave with wavenumber k: the mean of
// exp(-k |z - z'|) over all pairs.
double reduction_by_thickness(const Patch& patch, double k) {
  double sum = 0.0;
  for (const Vec3& a : patch.positions)
    for (const Vec3& b : patch.positions)
      sum += std::exp(-k * std::fabs(a.z() - b.z()));
  return sum / (static_cast<double>(patch.size()) * static_cast<double>(patch.size()));
}

// Of a ring with self-gravity at r_h 0.5. The slope of the pressure by surface density is that of the same ring without
// the wave, at optical depths from 0.85 to 1.15 (examples/overstability/pressure.py). A wave is faster than the ring
// heats and cools; so up to 5/3 of that slope, an adiabatic gas's, are allowed.
Row frequency_row(const Wave& wave) {
  constexpr double pressure_slope = 9.0; // m² Ω²
  const Patch& last = wave.patches.back();
  const double kappa = last.frequencies.kappa, k = two_pi / last.box.size_x;
  const double gravity = kappa * kappa * diagnostics::critical_wavelength(last) / last.box.size_x;
  const auto frequency = [&](double slope) {
    return std::sqrt(kappa * kappa - gravity * reduction_by_thickness(last, k) + slope * k * k);
  };
  const double lowest = frequency(pressure_slope), highest = frequency(5.0 / 3.0 * pressure_slope);
  const diagnostics::Growth measured = frequency_of(wave);
  return {.what = "frequency / Omega of that wave",
          .measured = measured.rate,
          .error = *measured.error,
          .expected = 0.5 * (lowest + highest),
          .tolerance = 0.5 * (highest - lowest) + 2.0 * *measured.error,
          .tolerance_is = "from the pressure of the steady ring to 5/3 of it, and twice the error",
          .source = "omega^2 = kappa^2 - 2 pi G Sigma k F + k^2 dP/dSigma (Schmit & Tscharnuter 1995), F by the "
                    "thickness of the layer",
          .command = "of the same run"};
}

// In a thin ring the same waves decay.
std::vector<Row> decay() {
  const char *sign = "the sign", *source = "overstable only at high optical depth (Salo, Schmidt & Spahn 2001)";
  const Wave longer = without_gravity(200.0), shorter = without_gravity(100.0);
  return {growth_row("200 m, nu 3.6, tau 0.5", longer, -0.01, 0.01, sign, source),
          growth_row("100 m, nu 3.6, tau 0.5", shorter, -0.02, 0.02, sign, source),
          ratio_row("rate of 100 m over that of 200 m, nu 3.6, tau 0.5", shorter, longer, 4.0, 0.8,
                    "20 %: another start changes a rate by as much")};
}

// At r_h 0.5 to 0.6 the wave grows, and the power of the density lies along the orbit, though small wakes are there as
// well. At 0.7 wakes make the structure, which leans. Nine orbits of it cannot show that no wave would grow in the end.
std::vector<Row> overstability_or_wakes() {
  const char *overstable = "overstable at r_h 0.5 to 0.6 (Mondino-Llermanos & Salo 2025, A&A 695, A37, Fig. 4)",
             *wakes = "wakes in place of overstability above r_h 0.65 (the same)";
  std::vector<Row> rows;
  for (const double hill : {0.5, 0.55, 0.6}) {
    const Wave wave = with_gravity(hill, 24.0);
    rows.push_back(
        growth_row(fmt::format("100 m, tau 1, eps 0.1, r_h {}", hill), wave, 0.01, 0.01, "the sign", overstable));
    if (hill == 0.5) // without wakes, which would be a pressure too
      rows.push_back(frequency_row(wave));
    const statistics::Measured angle =
        diagnostics::wake_geometry(wave.patches, diagnostics::critical_wavelength(wave.patches.back())).angle_degrees;
    rows.push_back({.what = fmt::format("angle of structure to the orbit in degrees, tau 1, eps 0.1, r_h {}", hill),
                    .measured = angle.value.value_or(0.0),
                    .expected = 0.0,
                    .tolerance = 7.5,
                    .tolerance_is = "half of the least pitch of wakes",
                    .source = overstable,
                    .command = "of the same run"});
  }
  const Wave inclined = with_gravity(0.7, 9.0);
  const diagnostics::WakeGeometry geometry =
      diagnostics::wake_geometry(inclined.patches, diagnostics::critical_wavelength(inclined.patches.back()));
  rows.push_back({.what = "pitch of the structure in degrees, tau 1, eps 0.1, r_h 0.7",
                  .measured = geometry.mean.pitch_degrees.value_or(0.0),
                  .expected = 22.5,
                  .tolerance = 10.0,
                  .tolerance_is = "wakes have 15 to 30 degrees; a box of 2 x 1.2 critical wavelengths",
                  .source = wakes,
                  .command = inclined.command});
  return rows;
}

// Where wakes and waves compete, friction takes the part of the waves.
std::vector<Row> friction() {
  const auto amplitude = [](const Wave& wave) {
    return diagnostics::analyze_radial_modes(wave.patches, 1)[0].density_amplitude;
  };
  const Wave smooth = with_gravity(0.65, 20.0),
             rough = with_gravity(0.65, 20.0, {"collisions.friction.tangential_restitution=0.5"});
  return {{.what = "amplitude of the axisymmetric wave, rough particles over smooth ones, tau 1, eps 0.1, r_h 0.65",
           .measured = amplitude(rough) / amplitude(smooth),
           .expected = 2.0,
           .tolerance = 0.9,
           .tolerance_is = "that it is larger",
           .source = "rough surfaces favour overstability, smooth ones wakes (Ballouz, Richardson & Morishima 2017)",
           .command = rough.command}};
}

} // namespace

std::vector<Subject> overstability_subjects() {
  return {{"overstability-decay", "Viscous overstability", true, decay},
          {"overstability-wakes", "Viscous overstability", false, overstability_or_wakes},
          {"overstability-friction", "Viscous overstability", false, friction}};
}

} // namespace keeler::validation
