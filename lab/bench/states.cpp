#include "states.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/tiled.hpp>
#include <keeler/scene/layer.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::bench {
namespace {

constexpr double moonlet_radius = 100.0;
constexpr double moonlet_orbits = 0.5; // relaxation of the particles around a moonlet

// The construction of one kind of state.
struct Recipe {
  particles::SizeLaw sizes;
  const char* table;        // `sizes` as in a scene file
  std::size_t largest_tile; // particles
  double heat;              // initial dispersion relative to equal spheres of the mass-weighted radius
  double orbits;            // to the equilibrium
  double step;              // orbits
};

// In a power law large particles stir small ones, which collide rarely: at τ = 0.5 particles below 1.5 m reach c_x =
// 230 m rad⁻¹, and particles above 12 m 50–100, within four orbits from half of this dispersion. Occasionally two large
// particles squeeze out a small one at 10⁴ m rad⁻¹; the short step keeps its path within one periodic image.
Recipe recipe_for(BenchSizes sizes) {
  if (sizes == BenchSizes::power)
    return {particles::power_sizes(3.0, 1.0, 100.0),
            "{ law = \"power\", exponent = 3.0, min = 1.0, max = 100.0 }",
            25000,
            2.0,
            3.0,
            0.0025};
  return {particles::equal_sizes(1.0), "{ law = \"equal\", radius = 1.0 }", 100000, 1.0, 1.5, 0.01};
}

// Returns the initial c_x, ⟨r⟩ Ω: near the equilibrium's, or larger if the particles could not be placed in so thin a
// layer. Equilibria of equal spheres at ε = 0.5 have 2.82, 2.18 and 1.62 at τ = 0.1, 0.5 and 1.
double initial_dispersion(const Recipe& recipe, std::size_t count, double optical_depth) {
  const particles::SizeLaw& sizes = recipe.sizes;
  const double placed =
      1.001 * dispersion_for_filling(optical_depth, scene::layer_sizes(sizes, count), 1.0, scene::largest_filling);
  const double mass_radius = sizes.mean_power(3) / sizes.mean_power(2);
  return std::max(3.0 * recipe.heat * mass_radius / sizes.mean_power(1) * std::exp(-0.62 * optical_depth), placed);
}

Scene tile_scene(const Recipe& recipe, std::size_t count, const DriftBenchSettings& s) {
  const double size = std::sqrt(pi * recipe.sizes.mean_power(2) * static_cast<double>(count) / s.optical_depth);
  return parse_scene(fmt::format(R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [{0}, {0}]
[particles]
count = {1}
density = 900.0
velocity_dispersion = {2}
sizes = {3}
[collisions]
finder = "{4}"
restitution = {{ law = "constant", value = 0.5 }}
[time]
step = {5}
end = {5}
)",
                                 size, count, initial_dispersion(recipe, count, s.optical_depth), recipe.table,
                                 s.finder, s.step_orbits),
                     "bench");
}

// Returns the number of small particles that a moonlet displaces in a layer of this optical depth.
double covered(double optical_depth, const particles::SizeLaw& sizes) {
  return optical_depth * moonlet_radius * moonlet_radius / sizes.mean_power(2);
}

void require_room_for_moonlet(double width) {
  constexpr double min_width = 3.0 * moonlet_radius;
  if (width < min_width)
    throw UsageError(
        fmt::format("too few particles for a moonlet: their box is {:.4g} m wide (a moonlet of {:g} m needs "
                    "{:g} m); raise --count or lower --optical-depth",
                    width, moonlet_radius, min_width));
}

double distance_from_centre(const Patch& patch, std::size_t k) {
  const Vec3& position = patch.positions[k];
  const Image image = patch.box.image_into_cell(position.x(), position.y(), patch.offset);
  return (position + patch.box.displacement(image, patch.offset)).norm();
}

} // namespace

Patch evolved(const Scene& scene, const Patch& start, double orbits, PhaseProgress& progress) {
  assert(orbits >= 0.0);
  Simulation simulation(scene, start);
  const long steps = std::lround(orbits / scene.time.step);
  for (long k = 0; k < steps; ++k) {
    simulation.advance();
    progress.add(static_cast<double>(start.size()));
  }
  return simulation.patch();
}

Patch with_moonlet(const Patch& patch, double radius) {
  assert(patch.size() > 0 && radius > 0.0);
  constexpr double clearance = 1e-6; // relative to the contact distance
  const double density = patch.masses.front() / std::pow(patch.radii.front(), 3);
  Patch result;
  result.box = patch.box;
  result.offset = patch.offset;
  result.frequencies = patch.frequencies;
  result.orbital_frequency = patch.orbital_frequency;
  result.time_orbits = patch.time_orbits;
  const auto add = [&](const Vec3& position, const Vec3& velocity, double r, double mass, std::uint64_t id) {
    result.positions.push_back(position);
    result.velocities.push_back(velocity);
    result.radii.push_back(r);
    result.masses.push_back(mass);
    result.ids.push_back(id);
  };
  for (std::size_t k = 0; k < patch.size(); ++k)
    if (distance_from_centre(patch, k) > (1.0 + clearance) * (radius + patch.radii[k]))
      add(patch.positions[k], patch.velocities[k], patch.radii[k], patch.masses[k], patch.ids[k]);
  add(Vec3::Zero(), Vec3::Zero(), radius, density * std::pow(radius, 3), patch.ids.back() + 1);
  return result;
}

BenchState bench_state(const DriftBenchSettings& settings, PhaseProgress& progress) {
  assert(settings.count > 0 && settings.optical_depth > 0.0);
  const Recipe recipe = recipe_for(settings.sizes);
  const bool moonlet = settings.sizes == BenchSizes::moonlet;
  double count = static_cast<double>(settings.count);
  if (moonlet)
    count += covered(settings.optical_depth, recipe.sizes);
  const double side = std::ceil(std::sqrt(count / static_cast<double>(recipe.largest_tile)));
  const double tile_count = std::max(1.0, std::round(count / (side * side)));
  BenchState state{tile_scene(recipe, static_cast<std::size_t>(tile_count), settings), {}};
  advice::require_memory_for(state.scene, settings.count);
  if (moonlet)
    require_room_for_moonlet(side * state.scene.size_x);

  const double particle_orbits = recipe.orbits * tile_count + (moonlet ? moonlet_orbits * count : 0.0);
  Scene making = state.scene;
  making.collisions.finder = "certified";
  making.time.step = recipe.step;
  progress.begin("preparing an equilibrium", particle_orbits / recipe.step);
  state.patch = evolved(making, initial_patch(making), recipe.orbits, progress);
  if (side > 1.0)
    state.patch =
        initial_conditions::tiled_patch(state.patch, static_cast<std::size_t>(side), static_cast<std::size_t>(side));
  if (moonlet)
    state.patch = evolved(making, with_moonlet(state.patch, moonlet_radius), moonlet_orbits, progress);
  return state;
}

} // namespace keeler::bench
