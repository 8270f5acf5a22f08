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
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/statistics/time_series.hpp>

#include <cstddef>
#include <optional>
#include <span>

namespace keeler::initial_conditions {

/// The patch at one instant.
struct SettleSample {
  double orbits = 0.0;
  /// Work of the shear so far: (energy lost in collisions + Σ m (½c² + ½ν²z²) + potential energy) / (M S²), m². Its
  /// rate is the viscosity.
  double work = 0.0;
  diagnostics::WakePower waves;
};

/// Returns the means with their tolerance: the larger of `bounds.change` and `standard_errors` of the difference.
WindowMeans compare(const Estimate& before, const Estimate& last, const MeanBounds& bounds, double standard_errors);

/// Compares the longest two windows of whole orbits that fit between the criterion's first orbit and the last sample
/// and end there. Returns nothing if they are shorter than its minimum. `orbit`: samples per orbit. Precondition:
/// samples in order of time.
std::optional<Settling> compare_windows(std::span<const SettleSample> history, std::size_t orbit,
                                        const SettleCriterion& criterion);

/// True if there are wakes, all means are accurate and agree, and the last sample is typical of them.
bool settled(const Settling& settling, const SettleCriterion& criterion);

} // namespace keeler::initial_conditions
