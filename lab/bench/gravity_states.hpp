// The states of the gravity benches: patches of Saturn's A ring with the physics of examples/a-ring-wakes.
//
// Wakes form in a patch of a few λ_cr. A large state is tiled with copies of it. Tiling is exact: the gravity of the
// tiles equals that of the one periodic patch.
#pragma once

#include "states.hpp"

#include <cstdint>
#include <string>

namespace keeler::bench {

/// Returns the example's physics in a square patch of `count` particles, or more if the patch would be narrower than
/// 2 λ_cr.
Scene a_ring_scene(std::size_t count, std::uint64_t seed);

/// Makes a state of `count` particles, rounded to whole tiles, and the scene that continues from it:
/// - settled: wakes 5 orbits after a uniform initial state, past their overshoot (settled.hpp); tiles of 6.5 × 6.5 λ_cr
/// - clumped: wakes as they form, after 1.5 orbits; at least 2 × 2 λ_cr
/// - uniform: a uniform initial state of at least 2 × 2 λ_cr
/// Preconditions: `count` > 0; `name` is one of gravity_state_names().
BenchState gravity_state(std::size_t count, const std::string& name, PhaseProgress& progress);

} // namespace keeler::bench
