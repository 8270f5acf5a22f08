// The states that benches of gravity time: a patch of Saturn's A ring, the physics of examples/a-ring-wakes.
//
// Wakes are made in a patch of a few λ_cr and its copies stand side by side in a large state, which is exact
// (bench_states.hpp): also their gravity is that of the one periodic patch.
#pragma once

#include <keeler/bench/states.hpp>

#include <cstdint>

namespace keeler {

enum class GravityState {
  clumped, ///< wakes stand, 1.5 orbits after a uniform start
  uniform  ///< a fresh patch
};

/// The physics of the example in a square patch of so many particles; at least two λ_cr wide, so there may be more.
Scene a_ring_scene(std::size_t count, std::uint64_t seed);

/// A patch evolved for some orbits by a scene's physics, with a coarser step and a coarser tree: to get somewhere.
Patch evolved_with_gravity(const Scene& scene, double orbits, PhaseProgress& progress);

/// `count` is rounded to whole tiles, and up to what a patch of two λ_cr holds. The scene goes on from the patch.
BenchState gravity_state(std::size_t count, GravityState kind, PhaseProgress& progress);

} // namespace keeler
