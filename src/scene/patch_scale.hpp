// The scale of a patch: its size, the density and speed of its particles, and its largest body. Choices and warnings
// are made by it.
#pragma once

#include <keeler/scene/scene.hpp>

#include <cstddef>
#include <optional>

namespace keeler::scene {

/// Density and speed of the particles of a start, in metres and radians of orbit.
struct StartScale {
  std::size_t particle_count = 0;   ///< 0: unknown, and no warnings
  double optical_depth = 0.0;       ///< Σ π r² over the area of the box
  double mean_radius = 0.0;         ///< m
  double usual_dispersion = 0.0;    ///< usual_dispersion(), m rad^-1
  double dispersion = 0.0;          ///< largest of c_x, c_y and c_z about the mean flow at each x, m rad^-1
  double height = 0.0;              ///< standard deviation of z, m
  double spread_x = 0.0;            ///< size of the box over the extent of the particles, along x
  double spread_y = 0.0;            ///< along y
  bool flat = false;                ///< the particles form a layer, not a ball
  std::optional<double> shear_seen; ///< −dv_y/dx over the shear rate S: 1 for circular orbits; none: too uncertain
  double orbital_frequency = 0.0;   ///< rad/s, for messages
  double shear = 0.0;               ///< S in units of orbital_frequency
};

/// Returns the velocity dispersion (m rad^-1) that collisions and self-gravity maintain in a ring, within a factor of a
/// few: the maximum of r Ω, the escape speed of the largest particle and the dispersion of Toomre's Q = 2. `newton_g`
/// and `kappa` are in internal units. Precondition: largest_radius > 0, kappa > 0.
double usual_dispersion(double largest_radius, double largest_mass, double surface_density, double newton_g,
                        double kappa);

/// The size of a patch, and its bodies.
struct PatchScale {
  struct Sphere {
    double radius = 0.0, mass = 0.0; ///< m, kg
  };
  std::size_t particle_count = 0;
  double size_x = 0.0, size_y = 0.0; ///< m
  double lambda_cr = 0.0;            ///< m
  double density = 0.0;              ///< of the particles' material, kg m^-3; used where the scene does not give it
  double mass = 0.0;                 ///< of all bodies, kg
  double optical_depth = 0.0;        ///< Σ π r² / area
  Sphere largest;                    ///< the largest body
  Sphere grain;                      ///< typical particle of the rest: R = ⟨r³⟩/⟨r²⟩, with the density above
  StartScale start = {};             ///< of a start; empty for a later state
};

/// Sums over the bodies of a patch that give its scale.
struct BodySums {
  double mass = 0.0;                               ///< kg
  double squares = 0.0, cubes = 0.0, sixths = 0.0; ///< of the radii, m², m³, m⁶
  PatchScale::Sphere largest;
};
/// Returns the scale of a patch. Precondition: size_x > 0, size_y > 0.
PatchScale scale_of(const BodySums& sums, std::size_t particle_count, double size_x, double size_y, double lambda_cr);

/// Returns the scale of a fresh start, moonlets included. Precondition: the scene has no start file.
PatchScale scale_of(const Scene& scene);

} // namespace keeler::scene
