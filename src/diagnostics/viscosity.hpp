// Angular momentum transport by random motions, and the viscosity that follows from the energy loss.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Returns the translational viscosity ν_trans = (1/S) ⟨ẋ (ẏ + S x)⟩, without the mean motion, m² rad^-1 (Wisdom &
/// Tremaine 1988, with S = 3/2). Times Ω it is in m² s^-1.
double translational_viscosity(const Patch& patch);

/// Returns the viscosity for this work of the shear on a mass in this time: work / (M S² t). Without external forces
/// the work is the energy lost in collisions plus the gain of Σ m (½c² + ½ν²z²) and of the potential energy. In the
/// units of the arguments.
constexpr double loss_viscosity(double work, double mass, double shear, double time) {
  return work / (mass * shear * shear * time);
}

} // namespace keeler::diagnostics
