#include <keeler/bench/states.hpp>

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
#include <cmath>

namespace keeler {
namespace {

constexpr double moonlet_radius = 100.0;
constexpr double moonlet_orbits = 0.5; // that the particles around a moonlet get to answer it

// How a state of each kind is made.
struct Recipe {
  SizeLaw sizes;
  const char* table;        // of the scene: the same sizes
  std::size_t largest_tile; // particles
  double heat;              // of the start, over equal spheres as large as the mass is
  double orbits;            // from the start to the equilibrium,
  double step;              // in steps of so many
};

// In a power law the large ones stir the small ones, which collide rarely: at τ = 0.5 those below 1.5 m get to c_x =
// 230 m rad⁻¹, those above 12 m to 50–100, within four orbits from half of the heat. Now and then two large ones
// squeeze a small one out at 10⁴ m rad⁻¹: within a short step that one still meets others through one image.
Recipe recipe_for(BenchSizes sizes) {
  if (sizes == BenchSizes::power)
    return {power_sizes(3.0, 1.0, 100.0),
            "{ law = \"power\", exponent = 3.0, min = 1.0, max = 100.0 }",
            25000,
            2.0,
            3.0,
            0.0025};
  return {equal_sizes(1.0), "{ law = \"equal\", radius = 1.0 }", 100000, 1.0, 1.5, 0.01};
}

// c_x of the start, in ⟨r⟩ Ω; more than near the equilibrium's where particles of that dispersion could not be placed.
// Equilibria of equal spheres at ε = 0.5 have 2.82, 2.18 and 1.62 at τ = 0.1, 0.5 and 1.
double first_dispersion(const Recipe& recipe, std::size_t count, double optical_depth) {
  const SizeLaw& sizes = recipe.sizes;
  const double placed = 1.001 * dispersion_for_filling(optical_depth, layer_sizes(sizes, count), 1.0, largest_filling);
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
                                 size, count, first_dispersion(recipe, count, s.optical_depth), recipe.table, s.finder,
                                 s.step_orbits),
                     "bench");
}

Patch evolved(Scene scene, const Patch& start, double orbits, double step, PhaseProgress& progress) {
  scene.collisions.finder = "certified";
  scene.time.step = step;
  Simulation simulation(scene, start);
  const long steps = std::lround(orbits / step);
  for (long k = 0; k < steps; ++k) {
    simulation.advance();
    progress.add(static_cast<double>(start.size()));
  }
  return simulation.patch();
}

// Small particles that a moonlet takes the place of, in a layer of this optical depth.
double covered(double optical_depth, const SizeLaw& sizes) {
  return optical_depth * moonlet_radius * moonlet_radius / sizes.mean_power(2);
}

void require_room_for_moonlet(double width) {
  constexpr double least = 3.0 * moonlet_radius;
  if (width < least)
    throw UsageError(fmt::format("too few particles for a moonlet: their box is {:.4g} m wide (one of {:g} m needs "
                                 "{:g} m); raise --count or lower --optical-depth",
                                 width, moonlet_radius, least));
}

double middle_distance(const Patch& patch, std::size_t k) {
  const Vec3& place = patch.positions[k];
  const Image image = patch.box.image_into_cell(place.x(), place.y(), patch.offset);
  return (place + patch.box.displacement(image, patch.offset)).norm();
}

} // namespace

Patch with_moonlet(const Patch& patch, double radius) {
  constexpr double clearance = 1e-6; // of the contact
  const double density = patch.masses.front() / std::pow(patch.radii.front(), 3);
  Patch result;
  result.box = patch.box;
  result.offset = patch.offset;
  result.frequencies = patch.frequencies;
  result.orbital_frequency = patch.orbital_frequency;
  result.time_orbits = patch.time_orbits;
  const auto add = [&](const Vec3& place, const Vec3& velocity, double r, double mass, std::uint64_t id) {
    result.positions.push_back(place);
    result.velocities.push_back(velocity);
    result.radii.push_back(r);
    result.masses.push_back(mass);
    result.ids.push_back(id);
  };
  for (std::size_t k = 0; k < patch.size(); ++k)
    if (middle_distance(patch, k) > (1.0 + clearance) * (radius + patch.radii[k]))
      add(patch.positions[k], patch.velocities[k], patch.radii[k], patch.masses[k], patch.ids[k]);
  add(Vec3::Zero(), Vec3::Zero(), radius, density * std::pow(radius, 3), patch.ids.back() + 1);
  return result;
}

BenchState bench_state(const DriftBenchSettings& settings, PhaseProgress& progress) {
  const Recipe recipe = recipe_for(settings.sizes);
  const bool moonlet = settings.sizes == BenchSizes::moonlet;
  double count = static_cast<double>(settings.count);
  if (moonlet)
    count += covered(settings.optical_depth, recipe.sizes);
  const double side = std::ceil(std::sqrt(count / static_cast<double>(recipe.largest_tile)));
  const double tile_count = std::max(1.0, std::round(count / (side * side)));
  BenchState state{tile_scene(recipe, static_cast<std::size_t>(tile_count), settings), {}};
  require_memory_for(state.scene, settings.count);
  if (moonlet)
    require_room_for_moonlet(side * state.scene.size_x);

  const double particle_orbits = recipe.orbits * tile_count + (moonlet ? moonlet_orbits * count : 0.0);
  progress.begin("preparing an equilibrium", particle_orbits / recipe.step);
  state.patch = evolved(state.scene, initial_patch(state.scene), recipe.orbits, recipe.step, progress);
  if (side > 1.0)
    state.patch = tiled_patch(state.patch, static_cast<std::size_t>(side), static_cast<std::size_t>(side));
  if (moonlet)
    state.patch =
        evolved(state.scene, with_moonlet(state.patch, moonlet_radius), moonlet_orbits, recipe.step, progress);
  return state;
}

} // namespace keeler
