// Random motion and height by particle size: small particles move faster and fill a thicker layer.
#pragma once

#include <keeler/particles/patch.hpp>

#include <vector>

namespace keeler {

/// Particles with smallest ≤ r < largest (the last class: ≤).
struct SizeClass {
  double smallest = 0.0, largest = 0.0; ///< m
  std::size_t count = 0;
  double mass_fraction = 0.0;
  Vec3 dispersion = Vec3::Zero(); ///< about the mean velocity of the whole patch, m rad⁻¹; 0 in an empty class
  double scale_height = 0.0;      ///< √⟨z²⟩, m; 0 in an empty class
};

inline constexpr int max_size_classes = 4;

/// Returns classes of equal width in log r from the smallest to the largest radius, in this order, or nothing if all
/// radii are equal. Means are weighted by mass. Precondition: at least one class.
std::vector<SizeClass> size_classes(const Patch& patch, int classes = max_size_classes);

} // namespace keeler
