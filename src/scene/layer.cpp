#include <keeler/scene/layer.hpp>

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

constexpr double volume_term = 1.7; // of H², in τ R²

} // namespace

double surface_density_per_depth(const particles::SizeLaw& sizes, double density) {
  return (4.0 / 3.0) * density * sizes.mean_power(3) / sizes.mean_power(2);
}

LayerSizes layer_sizes(const particles::SizeLaw& sizes, std::size_t count) {
  assert(count > 0);
  const double cubes = sizes.mean_power(3);
  double alone = 0.0; // Σ m²/(Σ m)²; continuous laws have many large particles
  if (sizes.listed > 0)
    alone = std::min(1.0, sizes.mean_power(6) / (cubes * cubes * static_cast<double>(count)));
  return {sizes.mean_power(1), cubes * (1.0 - alone) / sizes.mean_power(2)};
}

double layer_height(double optical_depth, const LayerSizes& sizes, double velocity_dispersion, double nu) {
  assert(optical_depth >= 0.0 && velocity_dispersion >= 0.0 && nu > 0.0);
  const double motion = vertical_fraction * velocity_dispersion * sizes.mean_radius / nu;
  return std::sqrt(motion * motion + volume_term * optical_depth * sizes.effective_radius * sizes.effective_radius);
}

double midplane_filling(double optical_depth, const LayerSizes& sizes, double velocity_dispersion, double nu) {
  const double height = layer_height(optical_depth, sizes, velocity_dispersion, nu);
  return (4.0 / 3.0) * optical_depth * sizes.effective_radius / (std::sqrt(two_pi) * height);
}

double dispersion_for_filling(double optical_depth, const LayerSizes& sizes, double nu, double filling) {
  assert(nu > 0.0 && filling > 0.0 && sizes.mean_radius > 0.0);
  const double height = (4.0 / 3.0) * optical_depth * sizes.effective_radius / (std::sqrt(two_pi) * filling);
  const double motion2 =
      height * height - volume_term * optical_depth * sizes.effective_radius * sizes.effective_radius;
  return motion2 > 0.0 ? nu * std::sqrt(motion2) / (vertical_fraction * sizes.mean_radius) : 0.0;
}

// f = a τ / √(m² + b τ) gives a² τ² − f² b τ − f² m² = 0.
double optical_depth_for_filling(const LayerSizes& sizes, double velocity_dispersion, double nu, double filling) {
  assert(nu > 0.0 && filling > 0.0);
  const double motion = vertical_fraction * velocity_dispersion * sizes.mean_radius / nu;
  const double a = (4.0 / 3.0) * sizes.effective_radius / (std::sqrt(two_pi) * filling);
  const double half = 0.5 * volume_term * sizes.effective_radius * sizes.effective_radius;
  return (half + std::sqrt(half * half + a * a * motion * motion)) / (a * a);
}

} // namespace keeler::scene
