// Clusters of a network against the transitive closure of "shares a joint", and their impulses against those of the
// whole network.
#include <bounded_impulses.hpp>
#include <clusters.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace clusters_test {

using namespace keeler;
using namespace keeler::contact_solver;

namespace {

// A network of few joints, so that it has many clusters. Normals point upwards from the lower body to the higher one,
// so impulses never cancel on the lowest body of a cluster: there are some that open all joints.
std::vector<Joint> random_joints(RandomStream& random, std::size_t bodies, std::size_t count) {
  std::vector<Joint> joints;
  while (joints.size() < count) {
    const auto a = static_cast<std::uint32_t>(static_cast<double>(bodies) * random.uniform());
    const auto b = static_cast<std::uint32_t>(static_cast<double>(bodies) * random.uniform());
    const Vec3 normal(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, 0.2 + random.uniform());
    if (a != b)
      joints.push_back({std::min(a, b), std::max(a, b), normal.normalized()});
  }
  return joints;
}

// Warshall's algorithm.
std::vector<std::vector<bool>> connected(const std::vector<Joint>& joints, std::size_t bodies) {
  std::vector<std::vector<bool>> reach(bodies, std::vector<bool>(bodies));
  for (const Joint& j : joints)
    for (const auto& [a, b] : {std::pair(j.low, j.high), {j.high, j.low}, {j.low, j.low}, {j.high, j.high}})
      reach[a][b] = true;
  for (std::size_t via = 0; via < bodies; ++via)
    for (std::size_t a = 0; a < bodies; ++a)
      for (std::size_t b = 0; b < bodies; ++b)
        reach[a][b] = reach[a][b] || (reach[a][via] && reach[via][b]);
  return reach;
}

bool ascending(std::span<const std::uint32_t> numbers) {
  return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
}

} // namespace

TEST_CASE("clusters are the connected components of a network") {
  RandomStream random(11, RandomPurpose::sample, 0);
  for (std::size_t trial = 0; trial < 200; ++trial) {
    constexpr std::size_t bodies = 24;
    const std::vector<Joint> joints = random_joints(random, bodies, trial % 30);
    const auto reach = connected(joints, bodies);
    const Clusters clusters(joints, bodies);
    std::vector<std::size_t> cluster_of(bodies, clusters.size());
    std::vector<int> seen(joints.size());
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      CHECK(ascending(clusters.joints(k)));
      CHECK(ascending(clusters.bodies(k)));
      CHECK((k == 0 || clusters.bodies(k - 1)[0] < clusters.bodies(k)[0]));
      for (std::size_t place = 0; place < clusters.bodies(k).size(); ++place) {
        cluster_of[clusters.bodies(k)[place]] = k;
        CHECK(clusters.place(clusters.bodies(k)[place]) == place);
      }
      for (const std::uint32_t joint : clusters.joints(k))
        ++seen[joint];
    }
    CHECK(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
    for (std::size_t k = 0; k < clusters.size(); ++k)
      for (const std::uint32_t joint : clusters.joints(k))
        CHECK(cluster_of[joints[joint].low] == k);
    for (std::size_t a = 0; a < bodies; ++a)
      for (std::size_t b = 0; b < bodies; ++b)
        CHECK(reach[a][b] == (cluster_of[a] == cluster_of[b] && cluster_of[a] < clusters.size()));
  }
}

TEST_CASE("the impulses of clusters by themselves move the bodies as those of the whole network do") {
  RandomStream random(12, RandomPurpose::sample, 0);
  constexpr std::size_t bodies = 60;
  constexpr double tolerance = 1e-11;
  for (std::size_t trial = 0; trial < 50; ++trial) {
    const std::vector<Joint> joints = random_joints(random, bodies, 30);
    const std::vector<double> tolerances(joints.size(), tolerance);
    std::vector<double> inverse_masses, required, impulses(joints.size());
    for (std::size_t b = 0; b < bodies; ++b)
      inverse_masses.push_back(std::pow(10.0, -2.0 * random.uniform()));
    for (std::size_t c = 0; c < joints.size(); ++c)
      required.push_back(2.0 * random.uniform() - 1.0);
    std::vector<Vec3> whole(bodies);
    BoundedImpulses network(joints, inverse_masses);
    REQUIRE(network.solve(required, tolerances, impulses));
    network.apply(impulses, whole);

    const Clusters clusters(joints, bodies);
    CHECK(clusters.size() > 3);
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      std::vector<Joint> own_joints;
      std::vector<double> own_masses, own_required;
      for (const std::uint32_t c : clusters.joints(k)) {
        own_joints.push_back({clusters.place(joints[c].low), clusters.place(joints[c].high), joints[c].normal});
        own_required.push_back(required[c]);
      }
      for (const std::uint32_t body : clusters.bodies(k))
        own_masses.push_back(inverse_masses[body]);
      std::vector<double> own_impulses(own_joints.size());
      std::vector<Vec3> own(own_masses.size());
      BoundedImpulses by_itself(own_joints, own_masses);
      REQUIRE(by_itself.solve(own_required, std::vector<double>(own_joints.size(), tolerance), own_impulses));
      by_itself.apply(own_impulses, own);
      for (std::size_t b = 0; b < own.size(); ++b)
        CHECK((own[b] - whole[clusters.bodies(k)[b]]).norm() < 1e-7 * (1.0 + own[b].norm()));
    }
  }
}

TEST_CASE("a network without joints has no clusters") {
  CHECK(Clusters({}, 5).size() == 0);
}

} // namespace clusters_test
