#include "settled.hpp"

#include "state_cache.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/tiled.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::bench {
namespace {

constexpr double disturbance = 1e-3; // of the velocities, over their dispersion
constexpr double parting_orbits = 0.05;

Patch evolved_in_phase(const Scene& scene, const Patch& start, double orbits, const char* phase,
                       PhaseProgress& progress) {
  progress.begin(phase, orbits / scene.time.step * static_cast<double>(start.size()));
  return evolved(scene, start, orbits, progress);
}

double end_orbits(const Scene& scene) {
  return static_cast<double>(scene.time.end_step) * scene.time.step;
}

// Returns the tiles in about as many rows as columns.
Patch tiles(const Patch& tile, std::size_t count) {
  const double number = std::max(1.0, static_cast<double>(count) / static_cast<double>(tile.size()));
  const double rows = std::round(std::sqrt(number)), columns = std::round(number / rows);
  return initial_conditions::tiled_patch(tile, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
}

Patch disturbed(Patch patch) {
  const Vec3 scale = disturbance * diagnostics::velocity_dispersion(patch);
  parallel_for(patch.size(), [&](std::size_t k) {
    RandomStream random(2, RandomPurpose::velocity, patch.ids[k]);
    for (int axis = 0; axis < 3; ++axis)
      patch.velocities[k][axis] += scale[axis] * random.normal();
  });
  return patch;
}

} // namespace

BenchState settled_state(const Scene& scene, std::size_t count, const std::filesystem::path& folder,
                         PhaseProgress& progress) {
  assert(count > 0);
  advice::require_memory_for(scene, count);
  const Patch tile = cached_patch(folder, scene, [&] {
    return evolved_in_phase(scene, initial_patch(scene), end_orbits(scene), "settling wakes, once", progress);
  });
  return {scene,
          evolved_in_phase(scene, disturbed(tiles(tile, count)), parting_orbits, "making tiles differ", progress)};
}

} // namespace keeler::bench
