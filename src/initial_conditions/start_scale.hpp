// For initial.cpp: density and velocities of the particles of a patch.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/patch_scale.hpp>

namespace keeler::initial_conditions {

/// Measures a patch of this total mass, kg. Collective, for a part of the particles: result on the root only.
scene::StartScale start_scale_of(const Patch& patch, double mass, const Communicator& ranks);

} // namespace keeler::initial_conditions
