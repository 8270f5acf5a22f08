// The state that a run begins with.
#pragma once

#include <keeler/simulation/state.hpp>

namespace keeler {

/// What messages call the state that a run begins with: its file, where it has one.
std::string start_name(const Scene& scene);

/// Of a patch of which each rank has some particles and the first one all else; collective. Throws InvariantError when
/// a number is not finite or, on one rank, particles overlap by more than rounding, UsageError when the largest does
/// not fit the box.
SimulationState first_state(const Scene& scene, const Patch& start, const Communicator& ranks);

} // namespace keeler
