// The natural units of a patch.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/particles/store.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler::runs {

/// Returns ⟨r⟩, Ω and G Σ. Precondition: the patch holds a particle.
quantities::PatchUnits units_of(const Patch& patch);

/// As above, of the particles of all ranks; `area` in m², `orbital_frequency` in rad/s. Collective. Precondition: there
/// is a particle.
quantities::PatchUnits units_of(const Particles& particles, double area, double orbital_frequency,
                                const Communicator& ranks);

} // namespace keeler::runs
