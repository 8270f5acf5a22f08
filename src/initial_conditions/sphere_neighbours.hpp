// Which spheres may come to touch before the lists are made again (Verlet 1967). Both partners of a pair have it in
// their lists, so that each sphere's pushes are added by one thread, in one order: that of the partners' numbers,
// wherever they stand in memory.
#pragma once

#include "sphere.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <span>
#include <vector>

namespace keeler {

struct Neighbour {
  std::uint32_t sphere;
  Image image;
};

class SphereNeighbours {
public:
  /// All pairs of the first `own` spheres with each other and with the rest whose distance is below (1 + skin) of the
  /// sum of their radii: complete until a sphere has moved by `skin` of its radius.
  void build(const std::vector<Sphere>& spheres, std::size_t own, const ShearingBox& box, double offset, double skin);

  std::span<const Neighbour> of(std::size_t sphere) const {
    return {entries_.data() + first_[sphere], entries_.data() + first_[sphere + 1]};
  }

private:
  std::vector<std::size_t> first_;
  std::vector<Neighbour> entries_;
};

} // namespace keeler
