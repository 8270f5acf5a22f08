// Particles that a user provides: a table as CSV or HDF5, in SI units.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/particles/patch.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace keeler::io {

/// One entry per particle, in the order of the table.
struct ParticleTable {
  std::string file;
  std::vector<Vec3> positions;    ///< m, Hill's frame
  std::vector<Vec3> velocities;   ///< m/s, Hill's frame, shear included; empty: not given
  std::vector<double> radii;      ///< m
  std::vector<double> masses;     ///< kg; empty: not given
  std::vector<std::size_t> lines; ///< line numbers in the text; empty for HDF5
  std::vector<Vec3> spins{};      ///< rad/s, inertial; empty: not given

  std::size_t size() const { return radii.size(); }

  /// Returns the location of a particle for messages: "FILE:17", or "FILE, row 12" (rows from 0).
  std::string location_of(std::size_t particle) const;
};

/// Reads a text with a line of names and one row per particle (files/columns.hpp), or an HDF5 file with one array per
/// column in its root and nothing else. The columns are x y z vx vy vz r m sx sy sz, in any order, with or without
/// units as suffixes (x_m, vx_m_s, r_m, m_kg, sx_rad_s). Optional are m, vx vy vz together, and sx sy sz together. A
/// column id is ignored. Values are not checked. Throws UsageError, naming file and row, when it is no such table or
/// has no row; IoError when the file cannot be read or is damaged.
ParticleTable read_particle_table(const std::filesystem::path& file);

/// Writes the particles of a patch as a text that reads back bit for bit: the id, then the columns above with their
/// units. Complete or not at all. Throws IoError.
void write_particle_table(const std::filesystem::path& file, const Patch& patch);

} // namespace keeler::io
