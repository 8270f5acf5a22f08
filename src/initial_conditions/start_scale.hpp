// For initial.cpp: how dense and how fast the particles of a patch are.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/patch_scale.hpp>

namespace keeler {

/// Of a patch of that mass in all, kg. Collective, of a part of the particles: on the first rank, on others nothing.
StartScale start_scale_of(const Patch& patch, double mass, const Communicator& ranks);

} // namespace keeler
