// How much ring there is on an area, and how near it is to collapse under its own weight.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler {

/// τ = Σ π r² / area.
double optical_depth(const Patch& patch);

/// Σ = Σ m / area, kg m^-2.
double surface_density(const Patch& patch);

/// Of the particles themselves, kg m^-3: their mass over their volume.
double material_density(const Patch& patch);

/// Fraction of the plane z = 0 that spheres cut: Σ π (r² − z²) over those that reach it, / area.
double midplane_filling(const Patch& patch);

/// λ_cr, m (orbit/toomre.hpp).
double critical_wavelength(const Patch& patch);

/// Q (orbit/toomre.hpp).
double toomre_q(const Patch& patch);

} // namespace keeler
