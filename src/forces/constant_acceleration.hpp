// A constant acceleration of all particles: a distant perturber, a steady drag, or a test of the step.
#pragma once

#include <keeler/forces/force.hpp>

namespace keeler::forces {

/// The entry of the scene's table [constant_acceleration].
ForceEntry constant_acceleration_entry();

} // namespace keeler::forces
