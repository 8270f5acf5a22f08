// A patch of ring at one instant, in Cartesian form, for snapshots, diagnostics and pictures. Internal units (m, kg,
// rad). Output uses such a copy and never changes the state of a run.
#pragma once

#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cstdint>
#include <vector>

namespace keeler::particles {

/// All arrays have one entry per particle, in increasing order of id.
struct Patch {
  std::vector<Vec3> positions;    ///< m, Hill's frame; guiding centres inside the cell
  std::vector<Vec3> velocities;   ///< m rad^-1, Hill's frame, shear included
  std::vector<double> radii;      ///< m
  std::vector<double> masses;     ///< kg
  std::vector<std::uint64_t> ids; ///< unique
  std::vector<Vec3> spins; ///< rad^-1, inertial angular velocity, components in Hill's frame; empty: smooth particles

  ShearingBox box;                ///< its size and shear
  double offset = 0.0;            ///< shear offset of the box at this instant, m
  Frequencies frequencies;        ///< κ/Ω, ν/Ω
  double orbital_frequency = 0.0; ///< Ω, rad/s, for conversion to SI
  double time_orbits = 0.0;       ///< since the run began

  std::size_t size() const { return positions.size(); } ///< number of particles
};

/// Throws InvariantError, naming the first such particle, if a position, velocity or spin is not finite, or a radius or
/// mass is not positive and finite.
void require_sound(const Patch& patch);

/// Returns the patch at `after` (rad) from the epoch of the particles; `offset` is the shear offset at that instant.
Patch make_patch(const Particles& particles, const ShearingBox& box, double offset, const Frequencies& frequencies,
                 double after);

/// Inverse of make_patch(): returns particles with elements at an epoch `ahead` (rad) after the instant of the patch.
Particles particles_from(const Patch& patch, double ahead);

} // namespace keeler::particles

namespace keeler {
using particles::Patch;
} // namespace keeler
