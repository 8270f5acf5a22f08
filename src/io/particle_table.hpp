// Tables of particles in SI units, of users and for other programs: CSV, plain HDF5, npz, extended XYZ, GADGET, VTP.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/particles/patch.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace keeler::io {

/// What a table says of the patch beside the particles. Zero: not stated.
struct TableFrame {
  double size_x = 0.0, size_y = 0.0; ///< m; centred on the origin
  double shear_offset = 0.0;         ///< m, of the box, from 0 to size_y
  double orbital_frequency = 0.0;    ///< rad/s
  double time_orbits = 0.0;

  bool has_box() const { return size_x > 0.0 && size_y > 0.0; }
};

/// One entry per particle, in the order of the table.
struct ParticleTable {
  std::string file;
  std::vector<Vec3> positions;      ///< m, Hill's frame
  std::vector<Vec3> velocities;     ///< m/s, Hill's frame, shear included; empty: not given
  std::vector<double> radii;        ///< m
  std::vector<double> masses;       ///< kg; empty: not given
  std::vector<std::size_t> lines;   ///< line numbers in a text; empty for other formats
  std::vector<Vec3> spins{};        ///< rad/s, inertial; empty: not given
  std::vector<std::uint64_t> ids{}; ///< of a table to write; a table that was read has none
  TableFrame frame{};

  std::size_t size() const { return radii.size(); }

  /// Returns the location of a particle for messages: "FILE:17", or "FILE, row 12" (rows from 0).
  std::string location_of(std::size_t particle) const;
};

/// Returns the particles of a patch, in SI and in the order of ids.
ParticleTable table_of(const Patch& patch);

/// Reads a table, in a format that its content tells: a text with a line of names and one row per particle
/// (files/columns.hpp); an HDF5 file with one array per column in its root; an HDF5 file of GADGET's kind (a group
/// PartTypeN, units stated); an npz file of numpy; a text in extended XYZ. The columns of texts and of plain HDF5 are
/// x y z vx vy vz r m sx sy sz, in any order, with or without units as suffixes (x_m, vx_m_s, r_m, m_kg, sx_rad_s).
/// Optional are m, vx vy vz together, and sx sy sz together. Ids are ignored. Values are not checked. Throws
/// UsageError, naming file and row, when it is no such table or has no row; IoError when the file cannot be read or is
/// damaged.
ParticleTable read_particle_table(const std::filesystem::path& file);

/// A format in which tables are written. Writers are interruptible; a file is complete or not there. Throws IoError,
/// UsageError. A table without velocities, masses or spins lacks these in the file too; without ids, row k has the id
/// k.
struct TableFormat {
  const char* name;
  const char* ending; ///< of files, with the dot
  const char* about;
  void (*write)(const std::filesystem::path& file, const ParticleTable& table);
};

/// Returns all formats.
std::span<const TableFormat> table_formats();

/// Returns the format of that name. Precondition: there is one.
const TableFormat& table_format(const std::string& name);

} // namespace keeler::io
