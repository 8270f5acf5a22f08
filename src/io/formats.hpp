// Names and versions of Keeler's HDF5 files: text attribute "format", integer attribute "format_version" on the root
// group of a checkpoint and on /Code of a snapshot and of a file of contacts.
#pragma once

#include <cstdint>

namespace keeler {

inline constexpr char checkpoint_format[] = "keeler checkpoint";
inline constexpr std::int64_t checkpoint_version = 4;

inline constexpr char snapshot_format[] = "keeler snapshot";
inline constexpr std::int64_t snapshot_version = 1;
inline constexpr char clumping_group[] = "Clumping"; // in snapshots of clumped states

inline constexpr char contacts_format[] = "keeler contacts";
inline constexpr std::int64_t contacts_version = 1;

} // namespace keeler
