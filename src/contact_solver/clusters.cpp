#include "clusters.hpp"

#include <keeler/core/counting_sort.hpp>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::contact_solver {
namespace {

// Union-find (Tarjan 1975): a tree for each cluster, its root the lowest body.
class Unions {
public:
  explicit Unions(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

  std::uint32_t root(std::uint32_t body) {
    while (parents_[body] != body) {
      parents_[body] = parents_[parents_[body]]; // halves the path
      body = parents_[body];
    }
    return body;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = root(a), root_b = root(b);
    parents_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

private:
  std::vector<std::uint32_t> parents_;
};

} // namespace

Clusters::Clusters(std::span<const Joint> joints, std::size_t bodies) : joints_(joints.size()), place_(bodies) {
  Unions unions(bodies);
  std::vector<std::uint8_t> has_joint(bodies);
  for (const Joint& j : joints) {
    assert(j.low < bodies && j.high < bodies);
    unions.unite(j.low, j.high);
    has_joint[j.low] = has_joint[j.high] = 1;
  }
  std::vector<std::uint32_t> cluster_of(bodies), cluster_of_body, cluster_of_joint;
  std::vector<std::uint32_t> joined; // the bodies that have joints
  std::uint32_t clusters = 0;
  for (std::uint32_t body = 0; body < bodies; ++body)
    if (has_joint[body]) {
      const std::uint32_t root = unions.root(body);
      cluster_of[body] = root == body ? clusters++ : cluster_of[root];
      cluster_of_body.push_back(cluster_of[body]);
      joined.push_back(body);
    }
  for (const Joint& j : joints)
    cluster_of_joint.push_back(cluster_of[j.low]);
  bodies_.resize(joined.size());
  counting_sort(cluster_of_joint, clusters, first_joint_,
                [&](std::size_t k, std::uint32_t position) { joints_[position] = static_cast<std::uint32_t>(k); });
  counting_sort(cluster_of_body, clusters, first_body_, [&](std::size_t k, std::uint32_t position) {
    bodies_[position] = joined[k];
    place_[joined[k]] = position;
  });
  for (const std::uint32_t body : joined)
    place_[body] -= first_body_[cluster_of[body]];
}

} // namespace keeler::contact_solver
