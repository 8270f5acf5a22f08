// The state that a run begins with.
#pragma once

#include <keeler/simulation/state.hpp>

namespace keeler {

/// Of a patch that the first rank has, and with it all particles; collective. Throws InvariantError when particles
/// overlap by more than rounding or a number is not finite, UsageError when the largest does not fit the box.
SimulationState first_state(const Scene& scene, const Patch& start, const Ranks& ranks);

} // namespace keeler
