// Means over the particles of a patch, weighted by mass: fluxes of momentum and energy count mass, and for
// equal spheres this is the plain mean that the literature quotes.
#pragma once

#include <keeler/core/threads.hpp>
#include <keeler/particles/patch.hpp>

namespace keeler {

/// Σ m, kg.
inline double total_mass(const Patch& patch) {
  return ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k]; });
}

/// Σ m q / Σ m for a quantity q(k) of particle k. The patch must hold a particle.
template<class Quantity> double mass_mean(const Patch& patch, const Quantity& quantity) {
  return ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k] * quantity(k); }) / total_mass(patch);
}

} // namespace keeler
