// A state that violates an invariant, saved for inspection.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace keeler::initial_conditions {

/// Removes the particles that are not valid in a snapshot (particle_fault). Returns their number.
std::size_t keep_possible(Patch& patch);

/// A violated invariant together with the state, which no file has.
struct BrokenState : InvariantError {
  BrokenState(const InvariantError& error, const Simulation& simulation);
  std::int64_t step;
  Patch patch; ///< Simulation::patch_at_break()
};

/// Writes a snapshot of the valid particles. Returns the message of the error, the time, and the file or the reason why
/// the state could not be saved.
std::string save_broken(const BrokenState& broken, const std::filesystem::path& file, const io::SnapshotMeta& meta);

} // namespace keeler::initial_conditions
