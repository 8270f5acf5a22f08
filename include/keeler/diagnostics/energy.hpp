// Epicyclic energy of a patch, split by what could release it: collisions feed on the two random parts and on the
// shear.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler {

/// Mass-weighted means per unit mass, m² rad^-2; their sum is ⟨½v² − S x² + ½ν² z²⟩.
struct PatchEnergy {
  double horizontal = 0.0; ///< ⟨½κ² e²⟩
  double vertical = 0.0;   ///< ⟨½ν² i²⟩
  double guiding = 0.0;    ///< ⟨−¼ S κ² X²⟩: depends on which image of a particle is inside the cell
  double total() const { return horizontal + vertical + guiding; }
};

PatchEnergy patch_energy(const Patch& patch);

} // namespace keeler
