// The natural units of a patch.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler::runs {

/// Returns ⟨r⟩, Ω and G Σ. Precondition: the patch holds a particle.
quantities::PatchUnits units_of(const Patch& patch);

} // namespace keeler::runs
