// How much ring there is on an area, and how near it is to collapse under its own weight.
#pragma once

#include <keeler/particles/patch.hpp>

namespace keeler {

/// τ = Σ π r² / area.
double optical_depth(const Patch& patch);

/// Σ = Σ m / area, kg m^-2.
double surface_density(const Patch& patch);

/// Fraction of the plane z = 0 that spheres cut: Σ π (r² − z²) over those that reach it, / area.
double midplane_filling(const Patch& patch);

/// λ_cr = 4π² G Σ / κ² (Toomre 1964), m: the longest wavelength at which gravity overcomes shear and rotation, and
/// about the spacing of self-gravity wakes.
double critical_wavelength(const Patch& patch);

/// Q = κ c_x / (3.36 G Σ) (Toomre 1964).
double toomre_q(const Patch& patch);

} // namespace keeler
