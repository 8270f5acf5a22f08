#include <keeler/diagnostics/dispersion.hpp>

#include <keeler/diagnostics/mean.hpp>

#include <cmath>

namespace keeler::diagnostics {
namespace {

Elements elements_now(const Patch& patch, std::size_t k) {
  return elements_from({patch.positions[k], patch.velocities[k]}, patch.frequencies, Rotation());
}

} // namespace

Vec3 mean_velocity(const Patch& patch) {
  Vec3 mean;
  for (int axis = 0; axis < 3; ++axis)
    mean[axis] = mass_mean(patch, [&](std::size_t k) { return peculiar_velocity(patch, k)[axis]; });
  return mean;
}

Vec3 velocity_dispersion(const Patch& patch) {
  const Vec3 mean = mean_velocity(patch);
  Vec3 dispersion;
  for (int axis = 0; axis < 3; ++axis) {
    const double variance = mass_mean(patch, [&](std::size_t k) {
      const double v = peculiar_velocity(patch, k)[axis] - mean[axis];
      return v * v;
    });
    dispersion[axis] = std::sqrt(variance);
  }
  return dispersion;
}

double scale_height(const Patch& patch) {
  return std::sqrt(mass_mean(patch, [&](std::size_t k) { return patch.positions[k].z() * patch.positions[k].z(); }));
}

double mean_eccentricity(const Patch& patch) {
  return mass_mean(patch, [&](std::size_t k) { return elements_now(patch, k).eccentricity(); });
}

double mean_inclination(const Patch& patch) {
  return mass_mean(patch, [&](std::size_t k) { return elements_now(patch, k).inclination(); });
}

double mean_radius(const Patch& patch) {
  return ordered_sum(patch.size(), [&](std::size_t k) { return patch.radii[k]; }) / static_cast<double>(patch.size());
}

} // namespace keeler::diagnostics
