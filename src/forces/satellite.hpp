// A satellite outside the box that passes the patch: its direct attraction, once or at every synodic period.
#pragma once

#include <keeler/forces/force.hpp>

namespace keeler {

/// The scene's table [satellite].
ForceEntry satellite_entry();

} // namespace keeler
