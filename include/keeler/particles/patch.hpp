// A patch of ring at one instant, in Cartesian form: what snapshots hold, what diagnostics measure and pictures show.
// Internal units (m, kg, rad); output works on such a copy and never touches the state of a run.
#pragma once

#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cstdint>
#include <vector>

namespace keeler {

/// All arrays have one entry a particle, in the order of the ids.
struct Patch {
  std::vector<Vec3> positions;  ///< m, Hill's frame; guiding centres inside the cell
  std::vector<Vec3> velocities; ///< m rad^-1, Hill's frame, the shear included
  std::vector<double> radii;    ///< m
  std::vector<double> masses;   ///< kg
  std::vector<std::uint64_t> ids;
  std::vector<Vec3> spins; ///< rad^-1, against the stars, in Hill's frame; empty: smooth particles

  ShearingBox box;
  double offset = 0.0;            ///< shear offset of the box at this instant, m
  Frequencies frequencies;        ///< κ/Ω, ν/Ω
  double orbital_frequency = 0.0; ///< Ω, rad/s: turns velocities into SI
  double time_orbits = 0.0;

  std::size_t size() const { return positions.size(); }
};

/// Throws InvariantError naming the first particle whose place or velocity is not finite, or whose radius or mass is
/// not positive and finite.
void require_sound(const Patch& patch);

/// The patch at `after` (rad) from the epoch of the particles; `offset` is the box's shear offset at that instant.
Patch make_patch(const Particles& particles, const ShearingBox& box, double offset, const Frequencies& frequencies,
                 double after);

/// The particles of a patch, with elements at an epoch `ahead` (rad) after the patch's instant.
Particles particles_from(const Patch& patch, double ahead);

} // namespace keeler
