// How rough particles spin.
#pragma once

#include <keeler/particles/patch.hpp>

#include <optional>

namespace keeler {

/// Weighted by mass. Spins are against the stars, rad⁻¹.
struct SpinState {
  Vec3 mean = Vec3::Zero();
  double dispersion = 0.0; ///< √⟨|ω − ⟨ω⟩|²⟩
  /// ⟨½ · 2/5 r² |ω − ⟨ω⟩|²⟩/⟨½c²⟩, c the velocity about the mean motion: in a thin ring of rough spheres
  /// 2(1 − ε_t)/(14 − 5(1 − ε_t)) (Morishima & Salo 2004).
  double energy_ratio = 0.0;
};

/// None: smooth particles, which have no spins.
std::optional<SpinState> spin_state(const Patch& patch);

} // namespace keeler
