#include <keeler/diagnostics/radial_profile.hpp>

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::diagnostics {

// Two passes in the order of the particles: means first, so that a common motion does not cancel digits.
std::vector<RadialBin> radial_profile(const Patch& patch, std::size_t bins) {
  assert(bins > 0);
  const ShearingBox& box = patch.box;
  const double width = box.size_x / static_cast<double>(bins), area = width * box.size_y;
  std::vector<RadialBin> profile(bins);
  std::vector<double> masses(bins, 0.0);
  const auto bin_of = [&](std::size_t k) {
    const Vec3& p = patch.positions[k];
    const double x = p.x() + box.size_x * box.image_into_cell(p.x(), p.y(), patch.offset).nx;
    const auto bin = static_cast<std::size_t>(std::max(0.0, (x + 0.5 * box.size_x) / width));
    return std::min(bin, bins - 1);
  };
  for (std::size_t b = 0; b < bins; ++b)
    profile[b].x = (static_cast<double>(b) + 0.5) * width - 0.5 * box.size_x;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const std::size_t b = bin_of(k);
    ++profile[b].count;
    masses[b] += patch.masses[k];
    profile[b].optical_depth += pi * patch.radii[k] * patch.radii[k] / area;
    profile[b].velocity += patch.masses[k] * peculiar_velocity(patch, k);
  }
  for (std::size_t b = 0; b < bins; ++b) {
    profile[b].surface_density = masses[b] / area;
    if (profile[b].count > 0)
      profile[b].velocity /= masses[b];
  }
  for (std::size_t k = 0; k < patch.size(); ++k) {
    RadialBin& bin = profile[bin_of(k)];
    const Vec3 v = peculiar_velocity(patch, k) - bin.velocity;
    bin.dispersion += patch.masses[k] * v.cwiseProduct(v);
  }
  for (std::size_t b = 0; b < bins; ++b)
    if (profile[b].count > 0)
      profile[b].dispersion = (profile[b].dispersion / masses[b]).cwiseSqrt();
  return profile;
}

} // namespace keeler::diagnostics
