// Names and versions of Keeler's HDF5 files: text attribute "format", integer attribute "format_version" on the root
// group of a checkpoint and on /Code of a snapshot and of a file of contacts.
#pragma once

#include "hdf5.hpp"

#include <cstdint>
#include <string_view>

namespace keeler {

/// The versions that can be read.
struct FormatVersions {
  std::int64_t oldest = 0, newest = 0;
};

/// Throws IoError, which names the Keeler that reads the file, where `object`'s format version is none of those.
/// `writer` has the provenance, `otherwise` says what else can be done with an older file.
void require_version(const hdf5::Handle& object, const hdf5::Handle& writer, const FormatVersions& versions,
                     std::string_view otherwise);

inline constexpr char checkpoint_format[] = "keeler checkpoint";
inline constexpr std::int64_t checkpoint_version = 5;

inline constexpr char snapshot_format[] = "keeler snapshot";
inline constexpr std::int64_t snapshot_version = 1;
inline constexpr char particles_group[] = "PartType1"; // as GADGET has it; all arrays of six have one entry a type
inline constexpr char ring_box_units[] = "lengths m; Omega rad/s; time_orbits orbits; time_s s; ratios 1";
inline constexpr char clumping_group[] = "Clumping"; // in snapshots of clumped states

inline constexpr char contacts_format[] = "keeler contacts";
inline constexpr std::int64_t contacts_version = 1;

} // namespace keeler
