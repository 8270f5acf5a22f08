// Spheres that ranks share while a start is made: each has those that were placed in its slab of the box, and copies of
// others' that may touch them.
//
// Slabs are equally wide. A sphere stays with its rank wherever it is pushed; copies reach as much farther as the
// farthest sphere is out of its slab. Held spheres are on all ranks, and no copies.
#pragma once

#include "sphere.hpp"

#include <keeler/comm/communicator.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <vector>

namespace keeler {

class SphereSlabs {
public:
  SphereSlabs(const Communicator& ranks, const ShearingBox& box) : ranks_(ranks), box_(box) {}

  const Communicator& ranks() const { return ranks_; }
  /// The rank in whose slab that is, in any image.
  std::size_t owner(const Vec3& place) const;
  bool has(const Vec3& place) const { return !ranks_.distributed() || owner(place) == ranks_.rank(); }

  /// Appends a copy of each sphere of another rank that may be nearer to one here, or to a place in the slab where one
  /// no larger than the largest may be, than `stretch` times the sum of their radii. Those that are there are no
  /// copies. Collective.
  void add_copies(std::vector<Sphere>& spheres, double stretch);
  /// Copies go where their spheres have gone. Collective.
  void update_copies(std::vector<Sphere>& spheres) const;

private:
  double slab_width() const { return box_.size_x / static_cast<double>(ranks_.size()); }
  double distance_outside(const Vec3& place) const;
  template<class Visit> void visit_slabs(double low, double high, const Visit& visit) const;

  Communicator ranks_;
  ShearingBox box_;
  std::size_t own_ = 0;                          // spheres that are no copies, the first ones
  std::vector<std::vector<std::uint32_t>> lent_; // to each rank
};

} // namespace keeler
