// The same acceleration for every particle: a distant disturber, a drag that never lets up, or a test of the step.
#pragma once

#include <keeler/forces/force.hpp>

namespace keeler {

/// The scene's table [constant_acceleration].
ForceEntry constant_acceleration_entry();

} // namespace keeler
