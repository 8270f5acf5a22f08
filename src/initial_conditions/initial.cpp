#include <keeler/initial_conditions/initial.hpp>

#include "aggregate.hpp"
#include "own_start.hpp"
#include "placing.hpp"
#include "start_scale.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/hill/toomre.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/initial_conditions/uniform.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/layer.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/planet.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {
namespace {

// Epicycles around one planet are not epicycles around another: the shear would be wrong everywhere.
void require_same_planet(const Patch& patch, const Scene& scene, const std::string& path) {
  const scene::PlanetSettings& planet = scene.planet;
  const auto differ = [](double a, double b) { return !(std::fabs(a - b) <= 1e-6 * std::fabs(b)); };
  if (differ(patch.orbital_frequency, planet.orbital_frequency) ||
      differ(patch.frequencies.kappa, planet.frequencies.kappa) || differ(patch.frequencies.nu, planet.frequencies.nu))
    throw UsageError(
        fmt::format("'{}' was made for another orbit (Omega {:.6g} rad/s, kappa/Omega {:.6g}, nu/Omega {:.6g}; the "
                    "scene has {:.6g}, {:.6g}, {:.6g}); give the scene the same [planet]",
                    path, patch.orbital_frequency, patch.frequencies.kappa, patch.frequencies.nu,
                    planet.orbital_frequency, planet.frequencies.kappa, planet.frequencies.nu));
}

// Keeps each particle with probability start.keep_fraction. The decision depends on id and seed only: equal for all
// states of a run, and a lower probability keeps a subset. Collective.
Patch thinned(Patch patch, const Scene& scene, const Communicator& ranks) {
  assert(patch.ids.size() == patch.size());
  std::vector<bool> keeps(patch.size());
  for (std::size_t k = 0; k < keeps.size(); ++k)
    keeps[k] = RandomStream(scene.start_keep_seed, RandomPurpose::thinning, patch.ids[k]).uniform() < scene.start_keep;
  const bool keeps_some = ranks.any(std::find(keeps.begin(), keeps.end(), true) != keeps.end());
  const std::size_t count = ranks.sum(patch.size());
  ranks.together([&] {
    if (!keeps_some)
      throw UsageError(
          fmt::format("start.keep_fraction = {} keeps none of the {} of '{}'; raise it, or try another start.keep_seed",
                      format_number(scene.start_keep), pluralize(count, "particle"), *scene.start_from));
  });
  const auto thin = [&](auto& rows) { // also for empty spins
    std::size_t kept = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (keeps[k])
        rows[kept++] = rows[k];
    rows.resize(kept);
  };
  thin(patch.positions);
  thin(patch.velocities);
  thin(patch.spins);
  thin(patch.radii);
  thin(patch.masses);
  thin(patch.ids);
  return patch;
}

// Returns the contribution of the drawn radii to the layer's height²: 1.7 τ R², with R of the typical particles.
double own_room(const UniformRequest& request, const Communicator& ranks) {
  ExactSum squares;
  for (const double r : request.radii)
    squares += r * r;
  ranks.merge({&squares});
  const double area = pi * squares.value();
  if (area == 0.0)
    return 0.0;
  const double radius = crowd_volume(request.radii, ranks) / (4.0 / 3.0 * area);
  const double height_in_radii =
      scene::layer_height(area / request.box.area(), {1.0, 1.0}, 0.0, request.frequencies.nu);
  return std::pow(radius * height_in_radii, 2);
}

Streamlines streamlines_of(const Scene& scene) {
  const scene::StreamlineSettings& settings = scene.particles.streamlines;
  Streamlines streamlines = Streamlines::bunched(settings.waves, scene.size_x, settings.bunching);
  streamlines.inclination = settings.inclination * scene.particles.sizes.mean_power(1);
  for (const scene::ModeSettings& mode : scene.particles.modes) {
    const auto add = mode.direction == scene::ModeSettings::Direction::outward  ? &Streamlines::add_outward
                     : mode.direction == scene::ModeSettings::Direction::inward ? &Streamlines::add_inward
                                                                                : &Streamlines::add_standing;
    (streamlines.*add)(mode.waves, scene.size_x, mode.amplitude, mode.phase_degrees * pi / 180.0);
  }
  return streamlines;
}

// Adds the aggregates; their particles are the last ones; other particles are placed around their balls.
void hold_aggregates(const Scene& scene, const particles::DrawnSizes& sizes, UniformRequest& request) {
  std::size_t number = 0;
  for (const scene::AggregateSettings& aggregate : scene.particles.aggregates) {
    std::vector<double> radii, densities;
    for (std::size_t k = aggregate.first; k < aggregate.first + aggregate.count; ++k) {
      radii.push_back(sizes.radius(k));
      densities.push_back(sizes.has_densities() ? sizes.density(k) : request.density);
    }
    const std::vector<HeldBody> bodies =
        aggregate_bodies(aggregate, ++number, {radii, densities}, request.frequencies, request.seed);
    request.held.insert(request.held.end(), bodies.begin(), bodies.end());
  }
}

std::vector<HeldBody> moonlets_of(const Scene& scene) {
  std::vector<HeldBody> moonlets;
  for (const scene::MoonletSettings& m : scene.moonlets) {
    const Vec3 circular(0.0, -scene.planet.frequencies.shear() * m.position.x(), 0.0);
    moonlets.push_back({m.position, circular + m.velocity / scene.planet.orbital_frequency, m.radius, m.mass});
  }
  return moonlets;
}

std::vector<ClosedBall> closed_balls(const Scene& scene) {
  std::vector<ClosedBall> balls;
  for (const scene::AggregateSettings& aggregate : scene.particles.aggregates)
    balls.push_back({aggregate.position, aggregate.radius});
  for (const scene::MoonletSettings& moonlet : scene.moonlets)
    balls.push_back({moonlet.position, moonlet.radius});
  return balls;
}

// Draws the radii of this rank's particles.
void take_radii(const particles::DrawnSizes& sizes, std::size_t count, const Communicator& ranks,
                UniformRequest& request) {
  request.first = count * ranks.rank() / ranks.size();
  request.radii.resize(count * (ranks.rank() + 1) / ranks.size() - request.first);
  parallel_for(request.radii.size(), [&](std::size_t k) { request.radii[k] = sizes.radius(request.first + k); });
}

UniformRequest request_of(const Scene& scene, const Communicator& ranks) {
  const particles::DrawnSizes sizes(scene.particles.sizes, scene.particles.count, scene.particles.seed);
  const double mean_radius = scene.particles.sizes.mean_power(1);
  UniformRequest request;
  request.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
  request.frequencies = scene.planet.frequencies;
  take_radii(sizes, scene.particles.free_count(), ranks, request);
  request.density = scene.particles.density;
  if (sizes.has_densities())
    request.density_of = [sizes](std::uint64_t id) { return sizes.density(id); };
  request.dispersion_x = scene.particles.velocity_dispersion * mean_radius;
  request.dispersion_z = scene::vertical_fraction * request.dispersion_x;
  request.streamlines = streamlines_of(scene);
  request.pattern = scene.particles.pattern;
  request.seed = scene.particles.seed;
  request.closed = closed_balls(scene);
  ranks.on_root([&] {
    hold_aggregates(scene, sizes, request);
    for (const HeldBody& moonlet : moonlets_of(scene))
      request.held.push_back(moonlet);
  });
  request.own_room = own_room(request, ranks);
  return request;
}

// Rough particles of an aggregate rotate with it rigidly.
void spin_aggregates(const Scene& scene, Patch& patch) {
  patch.spins.assign(patch.size(), Vec3::Zero());
  for (const scene::AggregateSettings& a : scene.particles.aggregates) {
    const auto first = std::lower_bound(patch.ids.begin(), patch.ids.end(), a.first);
    for (auto id = first; id != patch.ids.end() && *id < a.first + a.count; ++id)
      patch.spins[static_cast<std::size_t>(id - patch.ids.begin())].z() = a.spin;
  }
}

} // namespace

void require_start_file(const Scene& scene) {
  std::error_code unknown; // an inaccessible file is reported when it is read
  if (scene.start_from && !std::filesystem::exists(*scene.start_from, unknown) && !unknown)
    throw IoError(fmt::format("start.from names '{}', which does not exist", *scene.start_from));
}

Patch patch_from_snapshot(const std::string& path, const Scene& scene) {
  return patch_from_snapshot(io::read_snapshot(path).patch, path, scene);
}

Patch patch_from_snapshot(Patch patch, const std::string& path, const Scene& scene, const Communicator& ranks) {
  const std::size_t count = ranks.sum(patch.size());
  ranks.on_root([&] {
    require_possible_frame(patch, count, path);
    require_same_planet(patch, scene, path);
  });
  ranks.together([&] { require_possible_particles(patch, path); });
  // Velocities are stored in m/s; the scene's orbital frequency converts them to its units.
  for (std::vector<Vec3>* const rates : {&patch.velocities, &patch.spins})
    for (Vec3& rate : *rates)
      rate *= patch.orbital_frequency / scene.planet.orbital_frequency;
  patch.orbital_frequency = scene.planet.orbital_frequency;
  patch.frequencies = scene.planet.frequencies;
  patch.box.shear = scene.planet.frequencies.shear();
  patch.time_orbits = 0.0;
  patch.box.first_offset = patch.offset;
  return patch;
}

namespace {

// Returns the largest of all ranks' bodies, the heaviest of equal ones.
scene::PatchScale::Sphere largest_of(const Patch& patch, const Communicator& ranks) {
  scene::PatchScale::Sphere largest;
  for (const double radius : patch.radii)
    largest.radius = std::max(largest.radius, radius);
  largest.radius = ranks.max(largest.radius);
  for (std::size_t k = 0; k < patch.size(); ++k)
    if (patch.radii[k] == largest.radius)
      largest.mass = std::max(largest.mass, patch.masses[k]);
  largest.mass = ranks.max(largest.mass);
  return largest;
}

} // namespace

scene::PatchScale scale_of(const Patch& patch, const Communicator& ranks) {
  const auto total_of = [&](const auto& term) {
    return exact_total<ExactSum>(patch.size(), [&](ExactSum& sum, std::size_t k) { sum += term(k); });
  };
  const auto total_of_power = [&](int power) {
    return total_of([&](std::size_t k) { return std::pow(patch.radii[k], power); });
  };
  ExactSum masses = total_of([&](std::size_t k) { return patch.masses[k]; });
  ExactSum squares = total_of_power(2), cubes = total_of_power(3), sixths = total_of_power(6);
  ranks.merge({&masses, &squares, &cubes, &sixths});
  const double mass = masses.value();
  const scene::BodySums sums{mass, squares.value(), cubes.value(), sixths.value(), largest_of(patch, ranks)};
  scene::PatchScale scale = scale_of(
      sums, ranks.sum(patch.size()), patch.box.size_x, patch.box.size_y,
      hill::critical_wavelength(newton_g(patch.orbital_frequency), mass / patch.box.area(), patch.frequencies.kappa));
  scale.start = start_scale_of(patch, mass, ranks);
  return scale;
}

namespace {

Patch fresh_patch(const Scene& scene, const std::function<void(const StartProgress&)>& progress,
                  const Communicator& ranks) {
  Patch patch = uniform_patch(request_of(scene, ranks), progress, ranks);
  patch.orbital_frequency = scene.planet.orbital_frequency;
  if (scene.collisions.friction && !scene.particles.aggregates.empty())
    spin_aggregates(scene, patch);
  return patch;
}

} // namespace

Patch initial_patch(const Scene& scene, const std::function<void(const StartProgress&)>& progress,
                    const Communicator& ranks) {
  if (scene.start_from) {
    const std::string& path = *scene.start_from;
    return thinned(patch_from_snapshot(io::read_snapshot(path, ranks).patch, path, scene, ranks), scene, ranks);
  }
  constexpr double placing_bytes = 250.0; // per particle: the patch, its spheres and their neighbours
  const double count = static_cast<double>(scene.particles.count);
  ranks.together([&] {
    require_memory(placing_bytes * count / static_cast<double>(ranks.size()),
                   fmt::format("a start of {} particles", format_number(count)),
                   "use fewer particles or a machine with more");
  });
  return scene.particles.start ? placed_patch(scene, moonlets_of(scene), ranks) : fresh_patch(scene, progress, ranks);
}

} // namespace keeler::initial_conditions
