// Angular momentum that random motions carry outward, and the viscosity that the loss of energy shows.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler {

/// Translational viscosity ν_trans = (1/S) ⟨ẋ (ẏ + S x)⟩ with the mean motion removed, m² rad^-1 (Wisdom & Tremaine
/// 1988, where S = 3/2). Times Ω it is in m² s^-1.
double translational_viscosity(const Patch& patch);

/// The viscosity by which the shear did this work on a mass in this time: work / (M S² t). Where no external force
/// works, the work is the energy that collisions lost plus the gain of Σ m (½c² + ½ν²z²) and of the potential energy.
/// In the units of the arguments.
constexpr double loss_viscosity(double work, double mass, double shear, double time) {
  return work / (mass * shear * shear * time);
}

} // namespace keeler
