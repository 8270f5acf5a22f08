#include <keeler/scene/layer.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

// Returns the scale of a fresh patch, from the scene alone.
StartScale start_of(const Scene& scene) {
  const ParticleSettings& particles = scene.particles;
  const double largest = particles.sizes.largest;
  StartScale start;
  start.particle_count = particles.count;
  start.optical_depth = scene.optical_depth();
  start.mean_radius = particles.sizes.mean_power(1);
  start.usual_dispersion =
      usual_dispersion(largest, 4.0 / 3.0 * pi * particles.density * std::pow(largest, 3), scene.surface_density(),
                       newton_g(scene.planet.orbital_frequency), scene.planet.frequencies.kappa);
  start.dispersion = particles.velocity_dispersion * start.mean_radius;
  start.orbital_frequency = scene.planet.orbital_frequency;
  start.shear = scene.planet.frequencies.shear();
  return start;
}

} // namespace

double usual_dispersion(double largest_radius, double largest_mass, double surface_density, double newton_g,
                        double kappa) {
  assert(largest_radius > 0.0 && kappa > 0.0);
  const double escape = std::sqrt(2.0 * newton_g * largest_mass / largest_radius);
  const double toomre = 2.0 * 3.36 * newton_g * surface_density / kappa; // Q = 2
  return std::max({largest_radius, escape, toomre});
}

// A body that holds much of the mass by itself does not count for the grains, as in layer_sizes().
PatchScale scale_of(const BodySums& sums, std::size_t particle_count, double size_x, double size_y, double lambda_cr) {
  assert(size_x > 0.0 && size_y > 0.0);
  PatchScale scale;
  scale.particle_count = particle_count;
  scale.size_x = size_x;
  scale.size_y = size_y;
  scale.lambda_cr = lambda_cr;
  scale.mass = sums.mass;
  scale.density = sums.mass / (4.0 / 3.0 * pi * sums.cubes);
  scale.optical_depth = pi * sums.squares / (size_x * size_y);
  scale.largest = sums.largest;
  const double radius = (sums.cubes - sums.sixths / sums.cubes) / sums.squares;
  scale.grain = {radius, 4.0 / 3.0 * pi * scale.density * std::pow(radius, 3)};
  return scale;
}

PatchScale scale_of(const Scene& scene) {
  assert(!scene.start_from);
  const ParticleSettings& particles = scene.particles;
  const particles::SizeLaw& sizes = particles.sizes;
  const auto count = static_cast<double>(particles.count);
  const auto mass_of = [&](double cubes) { return 4.0 / 3.0 * pi * particles.density * cubes; };
  BodySums sums;
  sums.squares = count * sizes.mean_power(2);
  sums.cubes = count * sizes.mean_power(3);
  sums.sixths = count * sizes.mean_power(6);
  sums.mass = mass_of(sums.cubes);
  sums.largest = {sizes.largest, mass_of(std::pow(sizes.largest, 3))};
  for (const MoonletSettings& moonlet : scene.moonlets) {
    sums.squares += std::pow(moonlet.radius, 2);
    sums.cubes += std::pow(moonlet.radius, 3);
    sums.sixths += std::pow(moonlet.radius, 6);
    sums.mass += moonlet.mass;
    if (moonlet.radius > sums.largest.radius)
      sums.largest = {moonlet.radius, moonlet.mass};
  }
  PatchScale scale = scale_of(sums, particles.count, scene.size_x, scene.size_y,
                              critical_wavelength(scene.surface_density(), scene.planet));
  scale.start = start_of(scene);
  return scale;
}

} // namespace keeler::scene
