// keeler analyze --profile FILE: the radial profiles of all snapshots as CSV.
#pragma once

#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <span>

namespace keeler::cli {

inline constexpr std::size_t default_profile_bins = 100;

/// Writes one line per snapshot and bin; velocities of an empty bin are empty. Precondition: `bins` > 0. Throws
/// IoError.
void write_profiles(const std::filesystem::path& file, std::span<const Patch> patches, std::size_t bins);

} // namespace keeler::cli
