// The states of the gravity benches: patches of Saturn's A ring with the physics of examples/a-ring-wakes.
//
// Wakes form in a patch of a few λ_cr. A large state is tiled with copies of it (bench/states.hpp). Tiling is exact:
// the gravity of the tiles equals that of the one periodic patch.
#pragma once

#include "states.hpp"

#include <cstdint>

namespace keeler::bench {

enum class GravityState {
  clumped, ///< with wakes, 1.5 orbits after a uniform initial state
  uniform  ///< a uniform initial state
};

/// Returns the example's physics in a square patch of `count` particles, or more if the patch would be narrower than
/// 2 λ_cr.
Scene a_ring_scene(std::size_t count, std::uint64_t seed);

/// Makes a state of `count` particles, rounded to whole tiles and at least a patch of 2 × 2 λ_cr, and the scene that
/// continues from it. Precondition: `count` > 0.
BenchState gravity_state(std::size_t count, GravityState kind, PhaseProgress& progress);

} // namespace keeler::bench
