// Energy of the random motions in a patch.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Mass-weighted means per unit mass, m² rad^-2, without the energy of the mean epicycle: that of the mean vectors of e
/// and i, which a head wind makes large.
struct PatchEnergy {
  double horizontal = 0.0; ///< ½κ² (⟨e²⟩ − |⟨e⟩|²)
  double vertical = 0.0;   ///< ½ν² (⟨i²⟩ − |⟨i⟩|²)
};

PatchEnergy patch_energy(const Patch& patch);

} // namespace keeler::diagnostics
