// Angular momentum that random motions carry outward.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler {

/// Translational viscosity ν_trans = (1/S) ⟨ẋ (ẏ + S x)⟩ with the mean motion removed, m² rad^-1 (Wisdom & Tremaine
/// 1988, where S = 3/2). Times Ω it is in m² s^-1.
double translational_viscosity(const Patch& patch);

} // namespace keeler
