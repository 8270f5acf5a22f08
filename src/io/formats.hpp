// Names and versions of Keeler's HDF5 files: text attribute "format", integer attribute "format_version" on the root
// group of a checkpoint and on /Code of a snapshot or contact file.
#pragma once

#include "hdf5.hpp"

#include <cstdint>
#include <string_view>

namespace keeler::io {

/// Range of format versions that this program reads.
struct FormatVersions {
  std::int64_t oldest = 0, newest = 0;
};

/// Throws IoError when the format version of `object` is outside the range. The message names the version of Keeler
/// that reads the file, from the provenance in `writer`; `otherwise` tells what else can be done with an older file.
/// Precondition: oldest <= newest.
void require_version(const hdf5::Handle& object, const hdf5::Handle& writer, const FormatVersions& versions,
                     std::string_view otherwise);

inline constexpr char checkpoint_format[] = "keeler checkpoint";
inline constexpr std::int64_t checkpoint_version = 5;

inline constexpr char snapshot_format[] = "keeler snapshot";
inline constexpr std::int64_t snapshot_version = 1;
inline constexpr char particles_group[] = "PartType1"; // as in GADGET; arrays of six have one entry per type
inline constexpr char ring_box_units[] = "lengths m; Omega rad/s; time_orbits orbits; time_s s; ratios 1";
inline constexpr char clumping_group[] = "Clumping"; // in snapshots of clumped states

inline constexpr char contacts_format[] = "keeler contacts";
inline constexpr std::int64_t contacts_version = 1;

} // namespace keeler::io
