// Radial profiles of density and motion: means over the orbital direction in bins of equal width.
#pragma once

#include <keeler/particles/patch.hpp>

#include <vector>

namespace keeler::diagnostics {

/// Particles with centres in the bin, each at its image inside the cell. Motion is weighted by mass and 0 in an empty
/// bin.
struct RadialBin {
  double x = 0.0; ///< middle of the bin, m
  std::size_t count = 0;
  double surface_density = 0.0;   ///< kg m⁻²
  double optical_depth = 0.0;     ///< Σ π r² / area
  Vec3 velocity = Vec3::Zero();   ///< mean velocity relative to the shear flow, m rad⁻¹
  Vec3 dispersion = Vec3::Zero(); ///< about that mean, m rad⁻¹
};

/// Returns bins from −L_x/2 to L_x/2. Precondition: at least one bin.
std::vector<RadialBin> radial_profile(const Patch& patch, std::size_t bins);

} // namespace keeler::diagnostics
