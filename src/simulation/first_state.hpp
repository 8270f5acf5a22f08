// The initial state of a run.
#pragma once

#include <keeler/simulation/state.hpp>

namespace keeler::simulation {

/// Returns the name of the initial state in messages: its file, if it has one.
std::string start_name(const Scene& scene);

/// Makes the state from a patch of which each rank has some particles and the root all other data; collective. Throws
/// InvariantError if a number is not finite or, on one rank, particles overlap by more than rounding, UsageError if the
/// largest does not fit in the box.
SimulationState first_state(const Scene& scene, const Patch& start, const Communicator& ranks);

} // namespace keeler::simulation
