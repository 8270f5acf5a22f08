// Spins of rough particles.
#pragma once

#include <keeler/particles/patch.hpp>

#include <optional>

namespace keeler::diagnostics {

/// Weighted by mass. Spins are relative to the stars, rad⁻¹.
struct SpinState {
  Vec3 mean = Vec3::Zero();
  double dispersion = 0.0; ///< √⟨|ω − ⟨ω⟩|²⟩
  /// ⟨½ · 2/5 r² |ω − ⟨ω⟩|²⟩/⟨½c²⟩, c the velocity relative to the mean motion: in a thin ring of rough spheres
  /// 2(1 − ε_t)/(14 − 5(1 − ε_t)) (Morishima & Salo 2004).
  double energy_ratio = 0.0;
};

/// Returns nothing for smooth particles, which have no spins.
std::optional<SpinState> spin_state(const Patch& patch);

} // namespace keeler::diagnostics
