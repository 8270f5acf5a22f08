// Neighbour lists of spheres (Verlet 1967): the pairs that may touch before the lists are rebuilt. Both partners list a
// pair, so that each sphere's pushes are added by one thread, in the order of the partners' numbers, independent of
// their order in memory.
#pragma once

#include "sphere.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <cassert>
#include <span>
#include <vector>

namespace keeler::initial_conditions {

struct Neighbour {
  std::uint32_t sphere;
  Image image;
};

class SphereNeighbours {
public:
  /// Lists all pairs of the first `own` spheres with each other and with the rest at a distance below (1 + skin) ×
  /// (sum of their radii). Complete until a sphere has moved by `skin` of its radius.
  void build(const std::vector<Sphere>& spheres, std::size_t own, const ShearingBox& box, double offset, double skin);

  std::span<const Neighbour> of(std::size_t sphere) const {
    assert(sphere + 1 < first_.size());
    return {entries_.data() + first_[sphere], entries_.data() + first_[sphere + 1]};
  }

private:
  std::vector<std::size_t> first_;
  std::vector<Neighbour> entries_;
};

} // namespace keeler::initial_conditions
