// Distribution of spheres over ranks while a start is made: each rank has the spheres placed in its slab of the box,
// and copies of spheres of other ranks that may touch them.
//
// Slabs are equally wide. A sphere stays with its rank wherever it is pushed, and the range of copies grows by the
// distance of the farthest sphere outside its slab. Held spheres are on all ranks and never copied.
#pragma once

#include "sphere.hpp"

#include <keeler/comm/communicator.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <vector>

namespace keeler::initial_conditions {

class SphereSlabs {
public:
  SphereSlabs(const Communicator& ranks, const ShearingBox& box) : ranks_(ranks), box_(box) {}

  const Communicator& ranks() const { return ranks_; }
  /// Returns the owner of the slab that contains the position, in any image.
  std::size_t owner(const Vec3& position) const;
  bool has(const Vec3& position) const { return !ranks_.distributed() || owner(position) == ranks_.rank(); }

  /// Appends a copy of each sphere of another rank that may be closer than `stretch` times the sum of radii to a sphere
  /// here, or to a position in the slab at which a sphere no larger than the largest may be. Precondition: no copies
  /// yet. Collective.
  void add_copies(std::vector<Sphere>& spheres, double stretch);
  /// Moves the copies to the positions of their spheres. Collective.
  void update_copies(std::vector<Sphere>& spheres) const;

private:
  double slab_width() const { return box_.size_x / static_cast<double>(ranks_.size()); }
  double distance_outside(const Vec3& position) const;
  template<class Visit> void visit_slabs(double low, double high, const Visit& visit) const;

  Communicator ranks_;
  ShearingBox box_;
  std::size_t own_ = 0;                          // number of spheres that are no copies; they come first
  std::vector<std::vector<std::uint32_t>> sent_; // indices of the spheres copied to each rank
};

} // namespace keeler::initial_conditions
