// Random motion and height by particle size: small particles move faster and fill a thicker layer.
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/particles/patch.hpp>

#include <vector>

namespace keeler::diagnostics {

inline constexpr int max_size_classes = 4;

/// Returns classes of equal width in log r from the smallest to the largest radius, in this order, or nothing if all
/// radii are equal. Means are weighted by mass. Precondition: at least one class.
std::vector<SizeClass> size_classes(const Patch& patch, int classes = max_size_classes);

} // namespace keeler::diagnostics
