// What a particle meets where it is: random motion relative to its neighbours, and how crowded its place is. Wakes
// stream past each other and leave lanes empty, so means over the whole patch say little about either.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler {

/// The radius (m) of the neighbourhood in which motion counts as random: 3 mean radii or λ_cr/20, whichever is larger.
double local_radius(const Patch& patch);

struct LocalMotion {
  Vec3 dispersion = Vec3::Zero(); ///< c_x, c_y, c_z, m rad⁻¹; 0 when nobody has a neighbour
  double share = 0.0;             ///< of the mass: particles that have a neighbour
};

/// Velocity dispersion about the mean velocity of the neighbours within `radius` (m, in space). For each particle, the
/// mass-weighted variance of the peculiar velocities of itself and its neighbours, over 1 − Σm²/(Σm)² (for n equal
/// masses: (n − 1)/n, so that independent velocities give their true variance however few neighbours there are). The
/// mean over particles counts mass.
LocalMotion local_motion(const Patch& patch, double radius);

/// The radius (m) of the disc in which density is counted: 6 mean radii or λ_cr/10, whichever is larger.
double crowding_radius(const Patch& patch);

struct Crowding {
  double optical_depth = 0.0; ///< Σ πr² of the others in the disc about a particle, over its area; mean over mass
  double filling = 0.0;       ///< the same for what spheres cut out of the plane z = 0
  double thin_area = 0.0;     ///< share of the area in cells whose τ is below `thin_optical_depth`
  double cell_x = 0.0, cell_y = 0.0; ///< sides of these cells, m: near √π × radius, and a whole number a box
};

inline constexpr double thin_optical_depth = 0.1;

/// Particles count where their centres are. The particle in the middle does not count itself, so particles at random
/// give the plain optical depth.
Crowding crowding(const Patch& patch, double radius);

} // namespace keeler
