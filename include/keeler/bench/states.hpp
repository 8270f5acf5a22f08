// The states that benches time: patches near their collisional equilibrium without gravity, without overlaps.
//
// A large state is a small one side by side with copies of itself (states/tiled.hpp). Its particles meet as those of
// the small one do, until rounding tells them apart.
#pragma once

#include <keeler/bench/drift.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler {

/// A patch and the scene that goes on from it, with the finder and the step that are asked for. The scene's box and
/// count are those of the tile; nothing but a fresh start uses them.
struct BenchState {
  Scene scene;
  Patch patch;
};

/// Throws UsageError for an unknown finder or an impossible patch.
BenchState bench_state(const DriftBenchSettings& settings, PhaseProgress& progress);

/// Puts a sphere of the same density at rest into the middle, in place of all particles that it touches; it gets the
/// last id. The box must be wider than 2 (radius + the largest radius).
Patch with_moonlet(const Patch& patch, double radius);

} // namespace keeler
