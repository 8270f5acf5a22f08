// The state of a run at a broken invariant, saved as a snapshot: commands can read it, runs never continue from it.
#pragma once

#include "recorder.hpp"
#include "run_folder.hpp"

#include <keeler/core/error.hpp>
#include <keeler/simulation/simulation.hpp>

namespace keeler::runs {

/// Writes broken_NNNNNN.hdf, numbered by the step, and throws an InvariantError with the message of `error`, its time
/// and the file. The state is that of the last boundary, or of the last contact if the error occurred during a drift.
/// Particles that are invalid in a snapshot (particle_fault) are omitted.
[[noreturn]] void fail_broken(const InvariantError& error, const Simulation& simulation, const Scene& scene,
                              const RunFolder& folder, Recorder& recorder);

} // namespace keeler::runs
