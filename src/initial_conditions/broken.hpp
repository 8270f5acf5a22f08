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

/// What became of a broken state.
struct SavedState {
  std::int64_t step = 0;
  double orbits = 0.0; ///< the time
  std::filesystem::path file;
  std::size_t particles = 0, left_out = 0; ///< in the file, and not valid in a snapshot
  std::string failure;                     ///< of writing; empty if the file is complete
};

/// Returns the message of the error, the time, and the file or the reason why the state could not be saved.
std::string broken_message(const InvariantError& error, const SavedState& saved);

/// Writes a snapshot of the valid particles. Returns broken_message().
std::string save_broken(const BrokenState& broken, const std::filesystem::path& file, const io::SnapshotMeta& meta);

} // namespace keeler::initial_conditions
