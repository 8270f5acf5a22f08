#include "gravity_states.hpp"

#include "settled.hpp"
#include "state_cache.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/tiled.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace keeler::bench {
namespace {

constexpr double min_wavelengths = 2.0; // side of a tile, λ_cr
constexpr double settled_wavelengths = 6.5;
constexpr double evolving_step = 2e-3; // orbits
constexpr double evolving_angle = 0.7;
constexpr double clumping_orbits = 1.5;
constexpr double largest_clumped_tile = 12000.0; // particles: 4.5 λ_cr
constexpr double largest_uniform_tile = 100000.0;

Scene scene_of(double wavelengths, std::uint64_t seed, const std::vector<std::string>& overrides = {}) {
  return parse_scene(fmt::format(R"(
title = "A patch of Saturn's A ring"
[planet]
preset = "saturn-a-ring"
[box]
size_in_wavelengths = [{0}, {0}]
[particles]
optical_depth = 0.5
density = 600.0
velocity_dispersion = 3.5
sizes = {{ law = "equal", radius = 1.0 }}
seed = {1}
[collisions]
restitution = {{ law = "bridges", scale = 0.34 }}
[gravity]
solver = "tree"
opening_angle = 0.6
[time]
step = 1e-3
end = 1.0
)",
                                 wavelengths, seed),
                     "bench", overrides);
}

// Evolves a scene's initial state for some orbits, with a larger step and a less accurate tree than the scene's.
Patch evolved_with_gravity(const Scene& scene, double orbits, PhaseProgress& progress) {
  assert(orbits >= 0.0);
  Scene coarse = scene;
  coarse.time.step = evolving_step;
  coarse.gravity = GravitySettings{};
  coarse.gravity->opening_angle = evolving_angle;
  const Patch start = initial_patch(coarse);
  progress.begin("making wakes", orbits / evolving_step * static_cast<double>(start.size()));
  return evolved(coarse, start, orbits, progress);
}

} // namespace

Scene a_ring_scene(std::size_t count, std::uint64_t seed) {
  const auto min_count = static_cast<double>(scene_of(min_wavelengths, seed).particles.count);
  return scene_of(min_wavelengths * std::max(1.0, std::sqrt(static_cast<double>(count) / min_count)), seed);
}

BenchState gravity_state(std::size_t count, const std::string& name, PhaseProgress& progress) {
  assert(count > 0);
  if (name == "settled")
    return settled_state(scene_of(settled_wavelengths, 1, {"gravity={solver=\"fft\", kick_every=5}", "time.end=5.0"}),
                         count, cache_folder(), progress);
  const bool clumped = name == "clumped";
  const auto asked = static_cast<double>(count);
  const double side = std::ceil(std::sqrt(asked / (clumped ? largest_clumped_tile : largest_uniform_tile)));
  const long tile_count = std::lround(asked / (side * side));
  BenchState state{a_ring_scene(static_cast<std::size_t>(tile_count), 1), {}};
  advice::require_memory_for(state.scene, count);
  state.patch = clumped ? evolved_with_gravity(state.scene, clumping_orbits, progress) : initial_patch(state.scene);
  if (side > 1.0)
    state.patch =
        initial_conditions::tiled_patch(state.patch, static_cast<std::size_t>(side), static_cast<std::size_t>(side));
  return state;
}

} // namespace keeler::bench
