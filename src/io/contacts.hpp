// Contacts as data: one row per contact, in SI, in HDF5 files that each hold the next rows of one long table. The
// layout is in docs/formats.md. A file is written completely or not at all.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/io/provenance.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace keeler::io {

/// One contact of two spheres.
struct ContactRow {
  std::int64_t step = 0; ///< steps done before it
  double time_orbits = 0.0;
  Vec3 position = Vec3::Zero(); ///< of the contact point, m
  std::uint64_t low_id = 0, high_id = 0;
  Image image;                   ///< of the particle with the higher id
  double normal_speed = 0.0;     ///< approach speed along the line of centres, m/s
  double tangential_speed = 0.0; ///< relative speed across it before the contact, m/s
  bool fast = false;             ///< faster than v_cut
  Vec3 normal = Vec3::Zero();    ///< along the line of centres, from the lower id to the higher one
  Vec3 impulse = Vec3::Zero();   ///< that the particle with the higher id got, kg m/s
  bool at_rest = false;          ///< a contact at rest: its impulse carries a kick

  friend bool operator==(const ContactRow&, const ContactRow&) = default;
};

/// Content of a file beside its rows.
struct ContactMeta {
  std::int64_t first_row = 0;     ///< index of its first row in the whole table
  double orbital_frequency = 0.0; ///< rad/s
  std::string scene;              ///< the resolved scene, as TOML
  Provenance provenance;
};

struct ContactFile {
  ContactMeta meta;
  std::vector<ContactRow> rows;
};

/// Writes one file. Throws IoError.
void write_contacts(const std::filesystem::path& file, std::span<const ContactRow> rows, const ContactMeta& meta);

/// Reads one file. Throws IoError, also when the file is damaged or of another kind.
ContactFile read_contacts(const std::filesystem::path& file);

} // namespace keeler::io
