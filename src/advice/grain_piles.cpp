#include <keeler/advice/grain_piles.hpp>

#include <keeler/core/units.hpp>
#include <keeler/scene/layer.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/planet.hpp>
#include <keeler/scene/resting_choice.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::advice {
namespace {

constexpr double aggregates_last = 1.1; // r_h
constexpr double thin_ring = 0.5;       // optical depth: in denser rings the contact rates in wakes include aggregates

// Returns the moonlets, or else the largest body of a list of sizes.
std::vector<scene::PatchScale::Sphere> large_bodies(const Scene& scene, const scene::PatchScale& patch) {
  std::vector<scene::PatchScale::Sphere> bodies;
  for (const scene::MoonletSettings& moonlet : scene.moonlets)
    bodies.push_back({moonlet.radius, moonlet.mass});
  if (bodies.empty() && scene.particles.sizes.listed > 0)
    bodies.push_back(patch.largest);
  return bodies;
}

} // namespace

GrainPiles::GrainPiles(const Scene& scene) : count_(static_cast<double>(scene.particles.count)) {
  if (!scene.gravity || !scene.gravity->by_pairs())
    return;
  add_moonlets(scene);
  add_aggregates(scene);
}

// A body collects the grains of its radial lane of the patch, until its Hill sphere is full.
void GrainPiles::add_moonlets(const Scene& scene) {
  constexpr double filling = 0.55, reach = 0.85, lane = 5.0; // the latter two in Hill radii
  const scene::PatchScale patch = scale_of(scene);
  const double grain = std::pow(scene.particles.layer_sizes().effective_radius, 3);
  for (const scene::PatchScale::Sphere& body : large_bodies(scene, patch)) {
    if (!holds_grains(body, patch.grain, scene.planet))
      continue;
    const double hill = std::cbrt(newton_g(scene.planet.orbital_frequency) * body.mass / 3.0);
    const double capacity = filling * (std::pow(reach * hill, 3) - std::pow(body.radius, 3)) / grain;
    const double in_lane = count_ * std::min(1.0, lane * hill / scene.size_x);
    moonlets_.push_back(
        {count_ * hill * hill / (scene.size_x * scene.size_y), std::max(0.0, std::min(capacity, in_lane))});
  }
}

// Particles slower than their mutual escape speed form aggregates where r_h is large enough.
void GrainPiles::add_aggregates(const Scene& scene) {
  const scene::ParticleSettings& particles = scene.particles;
  const double r_h = scene::hill_parameter(particles.density, distance_from_saturn(scene.planet));
  const double depth = scene.optical_depth(), escape = std::sqrt(24.0 * std::pow(r_h, 3)); // r Ω
  if (r_h < aggregates_last || depth > thin_ring || particles.velocity_dispersion > escape)
    return;
  gathering_ = count_;
  half_orbits_ = 6.3 * std::sqrt(0.2 / depth);
}

double GrainPiles::grains(double orbits) const {
  assert(orbits >= 0.0);
  const double squared = orbits * orbits;
  double grains = gathering_ * squared / (squared + half_orbits_ * half_orbits_);
  for (const Moonlet& moonlet : moonlets_)
    grains += std::min(moonlet.capacity, 24.0 * moonlet.near * squared / (orbits + 0.25));
  return std::min(grains, count_);
}

double GrainPiles::grain_orbits(double orbits) const {
  constexpr int samples = 64;
  double sum = 0.0;
  for (int k = 0; k < samples; ++k)
    sum += grains(orbits * (k + 0.5) / samples);
  return orbits * sum / samples;
}

} // namespace keeler::advice
