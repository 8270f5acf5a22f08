// The states of the drift benches: patches near their collisional equilibrium without gravity, free of overlaps.
//
// A large state is tiled with copies of a small one (initial_conditions/tiled.hpp). Its collisions are copies of the
// small state's, until rounding makes them differ.
#pragma once

#include <keeler/bench/drift.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler::bench {

/// A patch and the scene that continues from it, with the requested finder and step. The scene's box and count are the
/// tile's; only a new initial state would use them.
struct BenchState {
  Scene scene;
  Patch patch;
};

/// Evolves a patch by the scene's step for some orbits; reports one particle and step as a unit of work.
Patch evolved(const Scene& scene, const Patch& start, double orbits, PhaseProgress& progress);

/// Makes the state. Precondition: count, step_orbits and optical_depth are positive.
/// Throws UsageError for an unknown finder or an impossible patch.
BenchState bench_state(const DriftBenchSettings& settings, PhaseProgress& progress);

/// Puts a sphere of the particles' density at rest into the centre, in place of all particles that it touches. It is
/// the last particle and has the largest id. Precondition: the patch has particles, and the box is wider than 2 (radius
/// + the largest radius).
Patch with_moonlet(const Patch& patch, double radius);

} // namespace keeler::bench
