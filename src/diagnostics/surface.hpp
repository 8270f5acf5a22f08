// Optical depth and surface density of a patch, and its gravitational stability.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Returns τ = Σ π r² / area.
double optical_depth(const Patch& patch);

/// Returns Σ = Σ m / area, kg m^-2.
double surface_density(const Patch& patch);

/// Returns the density of the particles, kg m^-3: total mass / total volume.
double material_density(const Patch& patch);

/// Returns the fraction of the plane z = 0 inside spheres: Σ π (r² − z²) over spheres that intersect it, / area.
double midplane_filling(const Patch& patch);

/// Returns λ_cr, m (hill/toomre.hpp).
double critical_wavelength(const Patch& patch);

/// Returns Q (hill/toomre.hpp).
double toomre_q(const Patch& patch);

} // namespace keeler::diagnostics
