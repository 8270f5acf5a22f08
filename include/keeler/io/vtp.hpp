// Particles for ParaView: a PolyData file of VTK (.vtp), its numbers as they are in memory (XML's "raw appended data"),
// and a collection (.pvd) that lists such files by time.
#pragma once

#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace keeler {

/// A vertex a particle, in the order of the ids, with the arrays of a snapshot in SI: Velocities, Masses, ParticleIDs,
/// Radius and, of rough particles, Spins. The time in orbits is VTK's TimeValue. Complete or not at all. Throws
/// IoError.
void write_vtp(const std::filesystem::path& file, const Patch& patch);

struct VtpInstant {
  double time_orbits = 0.0;
  std::string file; ///< its path from the collection's folder
};

/// Complete or not at all. Throws IoError.
void write_pvd(const std::filesystem::path& file, const std::vector<VtpInstant>& instants);

} // namespace keeler
