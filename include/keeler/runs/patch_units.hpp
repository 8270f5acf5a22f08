// The natural units of a patch.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/quantities/unit.hpp>

namespace keeler {

/// ⟨r⟩, Ω and G Σ. The patch must hold a particle.
PatchUnits units_of(const Patch& patch);

} // namespace keeler
