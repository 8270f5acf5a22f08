// Clusters of a network of bodies and joints: its connected components. Two joints are in one cluster if they share a
// body, or through a chain of joints that do. What happens in a cluster does not depend on the others.
//
// Invariants: each joint is in one cluster, and each body that has a joint; the joints and the bodies of a cluster are
// in increasing order, and clusters in the order of their lowest bodies.
#pragma once

#include "bounded_impulses.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::contact_solver {

class Clusters {
public:
  /// Precondition: bodies of joints are below `bodies`.
  Clusters(std::span<const Joint> joints, std::size_t bodies);

  std::size_t size() const { return first_body_.size() - 1; }
  /// Returns the joints of a cluster, by their positions in the network.
  std::span<const std::uint32_t> joints(std::size_t cluster) const { return part(joints_, first_joint_, cluster); }
  /// Returns the bodies of a cluster, by their numbers in the network.
  std::span<const std::uint32_t> bodies(std::size_t cluster) const { return part(bodies_, first_body_, cluster); }
  /// Returns the place of a body in bodies() of its cluster. Precondition: it has a joint.
  std::uint32_t place(std::uint32_t body) const { return place_[body]; }

private:
  static std::span<const std::uint32_t> part(const std::vector<std::uint32_t>& of,
                                             const std::vector<std::uint32_t>& first, std::size_t cluster) {
    return std::span(of).subspan(first[cluster], first[cluster + 1] - first[cluster]);
  }

  std::vector<std::uint32_t> joints_, bodies_; // by cluster
  std::vector<std::uint32_t> first_joint_, first_body_;
  std::vector<std::uint32_t> place_; // by body
};

} // namespace keeler::contact_solver
