#include "settling.hpp"

#include <keeler/core/units.hpp>

#include <cassert>
#include <limits>
#include <vector>

namespace keeler::initial_conditions {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Means over one window.
struct Window {
  Estimate viscosity, wavelength, radial_wavelength;
  double contrast = 0.0;
  std::size_t standing = 0; // samples
};

// Returns the wavelength of the summed spectra, with the error from single samples.
Estimate length_of(const std::optional<double>& sum, std::span<const double> singles) {
  return {sum.value_or(unknown), singles.empty() ? unknown : statistics::block_mean(singles).error};
}

// `before` is the last sample before the window.
Window window_of(const SettleSample& before, std::span<const SettleSample> samples) {
  std::vector<double> rates, lengths, radial_lengths;
  diagnostics::WakePower sums;
  const SettleSample* previous = &before;
  for (const SettleSample& sample : samples) {
    rates.push_back((sample.work - previous->work) / (two_pi * (sample.orbits - previous->orbits)));
    previous = &sample;
    sums += sample.waves;
    const diagnostics::WakeWaves waves = wake_waves(sample.waves);
    if (!waves.wavelength)
      continue;
    lengths.push_back(*waves.wavelength);
    radial_lengths.push_back(*waves.radial_wavelength);
  }
  const diagnostics::WakeWaves waves = wake_waves(sums);
  return {statistics::block_mean(rates), length_of(waves.wavelength, lengths),
          length_of(waves.radial_wavelength, radial_lengths), waves.contrast, lengths.size()};
}

bool within(const WindowMeans& means, const MeanBounds& bounds) {
  return means.mean() > 0.0 && means.error() <= bounds.error && means.change() <= means.tolerance;
}

} // namespace

WindowMeans compare(const Estimate& before, const Estimate& last, const MeanBounds& bounds, double standard_errors) {
  assert(bounds.change >= 0.0 && standard_errors >= 0.0);
  WindowMeans means{before, last, 0.0};
  means.tolerance = std::max(bounds.change, standard_errors * std::hypot(before.error, last.error) / means.mean());
  return means;
}

std::optional<Settling> compare_windows(std::span<const SettleSample> history, std::size_t orbit,
                                        const SettleCriterion& criterion) {
  assert(std::is_sorted(history.begin(), history.end(),
                        [](const SettleSample& a, const SettleSample& b) { return a.orbits < b.orbits; }));
  constexpr double rounding = 1e-9;
  const auto first = std::find_if(history.begin(), history.end(), [&](const SettleSample& sample) {
    return sample.orbits >= criterion.first_orbit - rounding;
  });
  const auto count = static_cast<std::size_t>(history.end() - first);
  const std::size_t orbits = orbit == 0 || count == 0 ? 0 : (count - 1) / (2 * orbit), length = orbits * orbit;
  if (orbits == 0 || orbits < criterion.min_window_orbits)
    return std::nullopt;
  const auto samples = history.last(2 * length + 1); // with the sample at which they begin
  const Window before = window_of(samples.front(), samples.subspan(1, length));
  const Window last = window_of(samples[length], samples.last(length));
  const auto of = [&](Estimate Window::*quantity, const MeanBounds& bounds) {
    return compare(before.*quantity, last.*quantity, bounds, criterion.standard_errors);
  };
  Settling settling;
  settling.window_orbits = orbits;
  settling.viscosity = of(&Window::viscosity, criterion.viscosity);
  settling.wavelength = of(&Window::wavelength, criterion.wavelengths);
  settling.radial_wavelength = of(&Window::radial_wavelength, criterion.wavelengths);
  settling.standing = static_cast<double>(std::min(before.standing, last.standing)) / static_cast<double>(length);
  settling.contrast = last.contrast;
  settling.deviation = last.contrast > 0.0
                           ? std::fabs(wake_waves(history.back().waves).contrast - last.contrast) / last.contrast
                           : HUGE_VAL;
  return settling;
}

bool settled(const Settling& settling, const SettleCriterion& criterion) {
  return settling.standing >= criterion.min_standing && within(settling.viscosity, criterion.viscosity) &&
         within(settling.wavelength, criterion.wavelengths) &&
         within(settling.radial_wavelength, criterion.wavelengths) && settling.deviation <= criterion.largest_deviation;
}

} // namespace keeler::initial_conditions
