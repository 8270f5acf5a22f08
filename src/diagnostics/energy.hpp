// Energy of the random motions in a patch.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Mass-weighted means per unit mass, m² rad^-2.
struct PatchEnergy {
  double horizontal = 0.0; ///< ⟨½κ² e²⟩
  double vertical = 0.0;   ///< ⟨½ν² i²⟩
};

PatchEnergy patch_energy(const Patch& patch);

} // namespace keeler::diagnostics
