// When self-gravity wakes have settled. They grow for two to five orbits, overshoot at orbits 3 to 4 where they are
// strong, and then wander for ever, because a box holds few wakes, which form and dissolve. So nothing before
// SettleCriterion::first_orbit counts, and means over two successive windows of whole orbits are compared: of the
// viscosity that the loss of energy gives, and of the wake lengths λ_⊥ and λ_x, weighted by power.
//
// How much such means differ for ever depends on the box: small boxes scatter more. So each mean comes with its error
// by blocks (statistics/time_series.hpp). Windows grow as orbits go by, until the means are known well enough to be
// compared. Wakes have settled when no mean differs from the one before by more than its tolerance.
#pragma once

#include <keeler/diagnostics/wake_spectrum.hpp>
#include <keeler/statistics/time_series.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace keeler {

/// What is asked of the means of a quantity in two successive windows, both in terms of the mean over the two.
struct MeanBounds {
  double error = 0.0;  ///< the largest standard error of either mean
  double change = 0.0; ///< a difference up to here is none, however small the errors are
};

/// docs/dev/starts.md has the runs from which these numbers were chosen.
struct SettleCriterion {
  double samples_per_orbit = 20.0;
  double first_orbit = 5.0; ///< no window begins before: the overshoot is over
  std::size_t min_window_orbits = 2;
  double max_orbits = 30.0; ///< not settled by then: never
  MeanBounds viscosity{.error = 0.10, .change = 0.10};
  MeanBounds wavelengths{.error = 0.05, .change = 0.05}; ///< λ_⊥ and λ_x
  double standard_errors = 2.0;    ///< of a difference, up to which it is none where they exceed MeanBounds::change
  double min_standing = 0.5;       ///< share of the samples of a window whose wakes stand out of the noise, one by one
  double largest_deviation = 0.15; ///< of the contrast of the last sample from that of the last window, of the latter

  /// Nothing can have settled before.
  double min_orbits() const { return first_orbit + 2.0 * static_cast<double>(min_window_orbits); }
};

/// The patch at one instant.
struct SettleSample {
  double orbits = 0.0;
  /// What the shear has worked until now: (energy lost in collisions + Σ m (½c² + ½ν²z²) + potential energy) over
  /// M S², m². Its rate is the viscosity.
  double work = 0.0;
  WakePower waves;
};

/// A quantity in two successive windows.
struct WindowMeans {
  Estimate before, last;
  double tolerance = 0.0; ///< of change()

  double mean() const { return 0.5 * (before.value + last.value); }
  double change() const { return std::fabs(last.value - before.value) / mean(); }
  double error() const { return std::max(before.error, last.error) / mean(); } ///< of the less certain one
};

/// WindowMeans with its tolerance by these bounds: the larger one of `bounds.change` and `standard_errors` of the
/// difference.
WindowMeans compare(const Estimate& before, const Estimate& last, const MeanBounds& bounds, double standard_errors);

/// The last two windows of a history.
struct Settling {
  std::size_t window_orbits = 0;
  WindowMeans viscosity;                     ///< m² rad⁻¹
  WindowMeans wavelength, radial_wavelength; ///< λ_⊥, λ_x, m; NaN in a window where no wakes stand
  double standing = 0.0;  ///< share of the samples whose wakes stand out of the noise, in the window with fewer such
  double contrast = 0.0;  ///< rms of the smoothed Σ/⟨Σ⟩ − 1 over the last window
  double deviation = 0.0; ///< |contrast of the last sample − contrast| / contrast
};

/// Compares the longest two windows of whole orbits that fit between the criterion's first orbit and the last sample,
/// and end there; none while they are shorter than its least. `orbit`: samples in one orbit.
std::optional<Settling> compare_windows(std::span<const SettleSample> history, std::size_t orbit,
                                        const SettleCriterion& criterion);

/// There are wakes, all means are known and the same, and the last sample is typical of them.
bool settled(const Settling& settling, const SettleCriterion& criterion);

} // namespace keeler
