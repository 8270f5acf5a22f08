#include "size_levels.hpp"

#include <algorithm>
#include <cassert>

namespace keeler::initial_conditions {

SizeLevels::SizeLevels(const std::vector<Sphere>& spheres, const ShearingBox& box, double offset) {
  for (const Sphere& sphere : spheres)
    largest_ = std::max(largest_, sphere.radius);
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const std::size_t l = level_of(spheres[k].radius);
    levels_.resize(std::max(levels_.size(), l + 1));
    levels_[l].members.push_back(static_cast<std::uint32_t>(k));
    levels_[l].largest = std::max(levels_[l].largest, spheres[k].radius);
  }
  std::vector<Vec3> positions;
  for (Level& level : levels_) {
    positions.clear();
    for (const std::uint32_t k : level.members)
      positions.push_back(spheres[k].position);
    level.grid.build(positions, box, offset, 2.0 * level.largest);
  }
}

std::size_t SizeLevels::level_of(double radius) const {
  assert(radius > 0.0 && radius <= largest_);
  return static_cast<std::size_t>(std::ilogb(largest_ / radius));
}

} // namespace keeler::initial_conditions
