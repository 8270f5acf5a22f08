// Velocity dispersion, scale height, mean eccentricity and inclination.
// All means are weighted by mass (diagnostics/mean.hpp).
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Returns the velocity relative to the shear flow, v + (0, S x, 0), m rad^-1: equal for all images of a particle.
inline Vec3 peculiar_velocity(const Patch& patch, std::size_t k) {
  return patch.velocities[k] + Vec3(0.0, patch.box.shear * patch.positions[k].x(), 0.0);
}

/// Returns the mass-weighted mean of the peculiar velocity, m rad^-1.
Vec3 mean_velocity(const Patch& patch);

/// Returns c = (c_x, c_y, c_z): the standard deviation of each component of the peculiar velocity, m rad^-1.
Vec3 velocity_dispersion(const Patch& patch);

/// Returns H = √⟨z²⟩, m.
double scale_height(const Patch& patch);

double mean_eccentricity(const Patch& patch); ///< ⟨e⟩, m
double mean_inclination(const Patch& patch);  ///< ⟨i⟩, m

/// Returns the unweighted mean of the radii, m: the unit of "r Ω".
double mean_radius(const Patch& patch);

/// Returns a velocity in m/s.
inline Vec3 velocity_si(const Patch& patch, const Vec3& velocity) {
  return velocity * patch.orbital_frequency;
}

/// Returns a velocity in units of ⟨r⟩ Ω.
inline Vec3 velocity_in_radii(const Patch& patch, const Vec3& velocity) {
  return velocity / mean_radius(patch);
}

} // namespace keeler::diagnostics
