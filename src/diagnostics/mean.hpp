// Mass-weighted means over the particles of a patch. Fluxes of momentum and energy are weighted by mass, and for equal
// spheres this is the plain mean of the literature.
#pragma once

#include <keeler/core/parallel.hpp>
#include <keeler/particles/patch.hpp>

#include <cassert>

namespace keeler::diagnostics {

/// Returns Σ m, kg.
inline double total_mass(const Patch& patch) {
  return ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k]; });
}

/// Returns Σ m q / Σ m for a quantity q(k) of particle k. Precondition: the patch is not empty.
template<class Quantity> double mass_mean(const Patch& patch, const Quantity& quantity) {
  assert(patch.size() > 0 && patch.masses.size() == patch.size());
  return ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k] * quantity(k); }) / total_mass(patch);
}

} // namespace keeler::diagnostics
