// Local properties, averaged over particles: random motion relative to neighbours, and crowding. Wakes stream past each
// other and leave lanes empty, so means over the whole patch represent either poorly.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Returns the radius (m) of the neighbourhood in which motion counts as random: the larger of 3 mean radii and
/// λ_cr/20.
double local_radius(const Patch& patch);

struct LocalMotion {
  Vec3 dispersion = Vec3::Zero(); ///< c_x, c_y, c_z, m rad⁻¹; 0 if no particle has a neighbour
  double fraction = 0.0;          ///< fraction of the mass in particles with a neighbour
};

/// Returns the velocity dispersion about the mean velocity of the neighbours within `radius` (m, in space). For each
/// particle: the mass-weighted variance of the peculiar velocities of itself and its neighbours, over 1 − Σm²/(Σm)²
/// (for n equal masses (n − 1)/n, which makes the variance of independent velocities unbiased for any n). The mean over
/// particles is weighted by mass.
LocalMotion local_motion(const Patch& patch, double radius);

/// Returns the radius (m) of the disc in which density is counted: the larger of 6 mean radii and λ_cr/10.
double crowding_radius(const Patch& patch);

struct Crowding {
  double optical_depth = 0.0; ///< Σ πr² of other particles in the disc about a particle / its area; mean by mass
  double filling = 0.0;       ///< likewise for the area that spheres cut out of the plane z = 0
  double thin_area = 0.0;     ///< area fraction of cells with τ below `thin_optical_depth`
  double cell_x = 0.0, cell_y = 0.0; ///< sides of these cells, m: near √π × radius, a whole number per box
};

inline constexpr double thin_optical_depth = 0.1;

/// Counts particles by their centres. The central particle is not counted, so random particles give the mean optical
/// depth.
Crowding crowding(const Patch& patch, double radius);

} // namespace keeler::diagnostics
