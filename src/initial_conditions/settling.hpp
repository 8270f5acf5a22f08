// Decides when self-gravity wakes have settled. They grow for two to five orbits, overshoot at orbits 3 to 4 if they
// are strong, and then fluctuate for ever, because a box holds few wakes, which form and dissolve. So samples before
// SettleCriterion::first_orbit are ignored, and means over two successive windows of whole orbits are compared: of the
// viscosity that follows from the loss of energy, and of the power-weighted wake lengths λ_⊥ and λ_x.
//
// The scatter of such means depends on the box: small boxes scatter more. So each mean has an error from block averages
// (statistics/time_series.hpp). Windows grow with time until the means are accurate enough to be compared. Wakes have
// settled when no mean differs from the one before by more than its tolerance.
#pragma once

#include <keeler/diagnostics/wake_spectrum.hpp>
#include <keeler/statistics/time_series.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace keeler {

/// Bounds on the means of a quantity in two successive windows, relative to the mean over both.
struct MeanBounds {
  double error = 0.0;  ///< largest standard error of either mean
  double change = 0.0; ///< a smaller difference is accepted, however small the errors are
};

/// docs/dev/starts.md has the runs from which these numbers were chosen.
struct SettleCriterion {
  double samples_per_orbit = 20.0;
  double first_orbit = 5.0; ///< begin of the earliest window: after the overshoot
  std::size_t min_window_orbits = 2;
  double max_orbits = 30.0; ///< give up after this
  MeanBounds viscosity{.error = 0.10, .change = 0.10};
  MeanBounds wavelengths{.error = 0.05, .change = 0.05}; ///< λ_⊥ and λ_x
  double standard_errors = 2.0;                          ///< accepted difference, if that exceeds MeanBounds::change
  double min_standing = 0.5;       ///< fraction of a window's samples with wakes above the noise, each by itself
  double largest_deviation = 0.15; ///< relative, of the contrast of the last sample from that of the last window

  /// Returns the earliest time at which wakes can have settled.
  double min_orbits() const { return first_orbit + 2.0 * static_cast<double>(min_window_orbits); }
};

/// The patch at one instant.
struct SettleSample {
  double orbits = 0.0;
  /// Work of the shear so far: (energy lost in collisions + Σ m (½c² + ½ν²z²) + potential energy) / (M S²), m². Its
  /// rate is the viscosity.
  double work = 0.0;
  WakePower waves;
};

/// A quantity in two successive windows.
struct WindowMeans {
  Estimate before, last;
  double tolerance = 0.0; ///< of change()

  double mean() const { return 0.5 * (before.value + last.value); }
  double change() const { return std::fabs(last.value - before.value) / mean(); }
  double error() const { return std::max(before.error, last.error) / mean(); } ///< the larger of the two
};

/// Returns the means with their tolerance: the larger of `bounds.change` and `standard_errors` of the difference.
WindowMeans compare(const Estimate& before, const Estimate& last, const MeanBounds& bounds, double standard_errors);

/// The last two windows of a history.
struct Settling {
  std::size_t window_orbits = 0;
  WindowMeans viscosity;                     ///< m² rad⁻¹
  WindowMeans wavelength, radial_wavelength; ///< λ_⊥, λ_x, m; NaN in a window without wakes
  double standing = 0.0;  ///< fraction of samples with wakes above the noise, the smaller of the two windows
  double contrast = 0.0;  ///< rms of the smoothed Σ/⟨Σ⟩ − 1 over the last window
  double deviation = 0.0; ///< |contrast of the last sample − contrast| / contrast
};

/// Compares the longest two windows of whole orbits that fit between the criterion's first orbit and the last sample
/// and end there. Returns nothing if they are shorter than its minimum. `orbit`: samples per orbit. Precondition:
/// samples in order of time.
std::optional<Settling> compare_windows(std::span<const SettleSample> history, std::size_t orbit,
                                        const SettleCriterion& criterion);

/// True if there are wakes, all means are accurate and agree, and the last sample is typical of them.
bool settled(const Settling& settling, const SettleCriterion& criterion);

} // namespace keeler
