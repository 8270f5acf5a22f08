// Particles of a user's own: a table as CSV or HDF5, in SI units.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/particles/patch.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace keeler {

/// One entry a particle, in the order of the table.
struct ParticleTable {
  std::string file;
  std::vector<Vec3> places;       ///< m, Hill's frame
  std::vector<Vec3> velocities;   ///< m/s, Hill's frame, the shear included; empty: not given
  std::vector<double> radii;      ///< m
  std::vector<double> masses;     ///< kg; empty: not given
  std::vector<std::size_t> lines; ///< in the text; empty for HDF5
  std::vector<Vec3> spins{};      ///< rad/s, against the stars; empty: not given

  std::size_t size() const { return radii.size(); }

  /// "FILE:17", or "FILE, row 12" from 0: where a particle stands, for messages.
  std::string place_of(std::size_t particle) const;
};

/// Reads a text with a line of names and a row a particle (files/columns.hpp), or an HDF5 file with an array for each
/// column in its root and nothing else. The columns are x y z vx vy vz r m sx sy sz, in any order, with or without
/// their units behind them (x_m, vx_m_s, r_m, m_kg, sx_rad_s); m may be missing, and vx vy vz or sx sy sz all together.
/// A column id is passed over. Numbers are not judged. Throws UsageError, naming file and row, where it is no such
/// table or has no row; IoError where the file cannot be read or is damaged.
ParticleTable read_particle_table(const std::filesystem::path& file);

/// Writes the particles of a patch as a text that reads back to the same bits: the id, then the columns above with
/// their units. Complete or not at all. Throws IoError.
void write_particle_table(const std::filesystem::path& file, const Patch& patch);

} // namespace keeler
