#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/layer.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

constexpr double min_wavelengths = 0.5; // λ_cr per side of a box in which wakes can grow: the fastest at Q = 1
constexpr double aggregates = 1.1;      // Hill parameter above which aggregates form
constexpr double max_fast = 3e4, max_slow = 6e4; // contacts per particle and orbit at the densest packing

double saturating(double rate, double limit) {
  return rate / (1.0 + rate / limit);
}

bool has_room_for_wakes(const Scene& scene) {
  const double wavelength = critical_wavelength(scene.surface_density(), scene.planet);
  return std::min(scene.size_x, scene.size_y) > min_wavelengths * wavelength;
}

// Returns what ν adds to the crowding of a layer without self-gravity. Below an optical depth of one the particles of a
// flattened layer lie side by side.
double vertical_crowding(double optical_depth, double vertical_ratio) {
  return layer_crowding(optical_depth) * std::min(1.0, std::pow(optical_depth, 3)) *
         (std::pow(vertical_ratio, 2.1) - 1.0);
}

// Returns the rate of contacts of particles that have lost their speed, over that at ν = Ω. It grows with the number of
// particles that lie on others.
double vertical_press(double optical_depth, double restitution, double vertical_ratio) {
  const double more = std::pow(vertical_ratio, std::min(3.7, 1.7 + 4.0 * restitution)) - 1.0;
  return std::max(0.0, 1.0 + more / (1.0 + more / (50.0 + 5000.0 * std::pow(optical_depth, 9))));
}

} // namespace

double size_spread(const particles::SizeLaw& sizes) {
  const double mean = sizes.mean_power(1);
  return sizes.mean_power(2) / (mean * mean);
}

double dilute_rate(double optical_depth, double vertical_ratio) {
  return 19.0 * optical_depth * std::pow(vertical_ratio, 0.9);
}

double encountered_optical_depth(const Scene& scene) {
  return 0.5 * scene.optical_depth() * (1.0 + 1.0 / size_spread(scene.particles.sizes));
}

double typical_restitution(const Scene& scene) {
  const double radius = scene.particles.layer_sizes().effective_radius;
  return scene.collisions.restitution(
      {.speed = 3.0 * radius * scene.planet.orbital_frequency, .radius_low = radius, .radius_high = radius});
}

double layer_crowding(double optical_depth) {
  return std::pow(optical_depth, 1.8);
}

// Self-gravity compresses a layer: 4π G ρ/Ω² ∝ r_h³.
double compressed_crowding(double optical_depth, double hill_parameter) {
  return 247.0 * std::pow(optical_depth, 0.9) * std::pow(std::min(hill_parameter, aggregates), 6);
}

double wake_crowding(double optical_depth, double hill_parameter) {
  const double depth = 2.0 * optical_depth;
  return 2.0 * std::pow(depth, 3) / (1.0 + std::pow(depth, 1.5)) *
         std::exp(12.5 * (std::min(hill_parameter, aggregates) - 0.39));
}

// A particle of a dilute layer collides 19 τ times per orbit, more often with a higher vertical frequency. Particles
// that lose their speed stay together and collide again: more often with less restitution and more crowding. Small
// particles of a wide distribution move too fast for slow contacts. Spheres of zero restitution hop at the minimum
// rebound (v_cut/1000), thousands of times per orbit.
ContactRates contact_rates(double optical_depth, double restitution, double crowding, double spread,
                           double vertical_ratio) {
  assert(optical_depth >= 0.0 && restitution >= 0.0 && spread > 0.0 && vertical_ratio > 0.0);
  const double dilute = dilute_rate(optical_depth, vertical_ratio);
  const double flat = crowding + vertical_crowding(optical_depth, vertical_ratio);
  const double fast = dilute * (1.0 + 4.5 * std::exp(-7.2 * restitution) * flat);
  const double slow = dilute * vertical_press(optical_depth, restitution, vertical_ratio) *
                      (34.0 * std::exp(-13.0 * restitution) * (1.0 / (spread * spread * spread) + crowding / 7.0) +
                       0.12 / (restitution + 7e-5) * std::exp(-30.0 * restitution));
  return {saturating(fast, max_fast), saturating(slow, max_slow)};
}

SceneContacts scene_contacts(const Scene& scene) {
  assert(!scene.start_from);
  const double depth = scene.optical_depth(), spread = size_spread(scene.particles.sizes);
  const auto rates = [&](double crowding) {
    return contact_rates(encountered_optical_depth(scene), typical_restitution(scene), layer_crowding(depth) + crowding,
                         spread, scene.planet.frequencies.nu);
  };
  if (!scene.gravity || !scene.gravity->by_pairs())
    return {rates(0.0), rates(0.0)};
  const double r_h = hill_parameter(scene.particles.density, distance_from_saturn(scene.planet));
  const double compressed = compressed_crowding(depth, r_h);
  const bool wakes = has_room_for_wakes(scene);
  return {rates(compressed), rates(wakes ? std::max(compressed, wake_crowding(depth, r_h)) : compressed)};
}

} // namespace keeler::scene
