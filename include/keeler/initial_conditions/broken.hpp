// A state in which an invariant broke, kept so that it can be looked at.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace keeler {

/// Takes the particles out that no snapshot may have (particle_fault). Returns how many.
std::size_t keep_possible(Patch& patch);

/// What broke, with the state: where nothing else keeps it.
struct BrokenState : InvariantError {
  BrokenState(const InvariantError& error, const Simulation& simulation);
  std::int64_t step;
  Patch patch; ///< Simulation::patch_at_break()
};

/// Writes a snapshot of what is possible in it. Returns the words of the error, when it was, and the file; or why the
/// state could not be saved.
std::string save_broken(const BrokenState& broken, const std::filesystem::path& file, const SnapshotMeta& meta);

} // namespace keeler
