// What a run leaves when an invariant breaks: its state, as a snapshot that commands can look at and no run takes up.
#pragma once

#include "recorder.hpp"
#include "run_folder.hpp"

#include <keeler/core/error.hpp>
#include <keeler/simulation/simulation.hpp>

namespace keeler {

/// Writes broken_NNNNNN.hdf, numbered by the step, and throws an InvariantError with the words of `error`, when it was,
/// and the file. The state is that of the last boundary, or of the last contact in the middle of a drift. Particles
/// that no snapshot may have (particle_fault) are left out.
[[noreturn]] void fail_broken(const InvariantError& error, const Simulation& simulation, const Scene& scene,
                              const RunFolder& folder, Recorder& recorder);

} // namespace keeler
