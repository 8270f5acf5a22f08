// Linear drag by gas on circular orbits that are slower than the particles' by a head wind.
#pragma once

#include <keeler/forces/force.hpp>

namespace keeler::forces {

/// The entry of the scene's table [gas].
ForceEntry gas_entry();

} // namespace keeler::forces
