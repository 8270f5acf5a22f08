// A patch of wakes that have settled, as most steps of a long run are: tiles of an evolved patch whose copies have
// different histories.
#pragma once

#include "states.hpp"

#include <cstddef>
#include <filesystem>

namespace keeler::bench {

/// Returns about `count` particles, at least one tile: copies of the patch that the run of this scene ends with, side
/// by side. The tile is kept in `folder` (state_cache.hpp). Copies would touch at equal times, so all velocities change
/// by a random thousandth of the dispersion, and collisions make more of that for some steps.
/// Preconditions: `count` > 0; the scene's run and 1/20 of an orbit are whole kick intervals.
BenchState settled_state(const Scene& scene, std::size_t count, const std::filesystem::path& folder,
                         PhaseProgress& progress);

} // namespace keeler::bench
