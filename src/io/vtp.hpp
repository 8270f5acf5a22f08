// Particles for ParaView: a VTK PolyData file (.vtp) with raw appended binary data, and a collection (.pvd) that lists
// such files by time.
#pragma once

#include <keeler/io/particle_table.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace keeler::io {

/// Writes one vertex per particle, in the order of the table, with the arrays of a snapshot in SI: Velocities, Masses,
/// ParticleIDs, Radius and Spins, as far as the table has them. TimeValue is the time in orbits. Complete or not at
/// all. Throws IoError.
void write_vtp(const std::filesystem::path& file, const ParticleTable& table);

struct VtpInstant {
  double time_orbits = 0.0;
  std::string file; ///< path relative to the collection's folder
};

/// Writes the collection. Complete or not at all. Throws IoError.
void write_pvd(const std::filesystem::path& file, const std::vector<VtpInstant>& instants);

} // namespace keeler::io
