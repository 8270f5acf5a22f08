#include <keeler/diagnostics/clusters.hpp>

#include "states.hpp"

#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <numeric>
#include <set>

namespace clusters_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

using Partition = std::set<std::vector<std::uint32_t>>;

Partition partition_of(const std::vector<Cluster>& clusters) {
  Partition partition;
  for (const Cluster& c : clusters)
    partition.insert(c.members);
  return partition;
}

// Brute force: all pairs and images, labels propagated until nothing changes.
Partition by_all_pairs(const Patch& patch, double gap) {
  std::vector<std::size_t> label(patch.size());
  std::iota(label.begin(), label.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < patch.size(); ++i)
      for (std::size_t j = 0; j < patch.size(); ++j)
        for (int nx = -2; nx <= 2; ++nx)
          for (int ny = -4; ny <= 4; ++ny) {
            const Vec3 d = patch.positions[j] + patch.box.displacement({nx, ny}, patch.offset) - patch.positions[i];
            if (label[j] > label[i] && d.norm() <= (patch.radii[i] + patch.radii[j]) * (1.0 + gap)) {
              label[j] = label[i];
              changed = true;
            }
          }
  }
  std::vector<std::vector<std::uint32_t>> groups(patch.size());
  for (std::uint32_t k = 0; k < patch.size(); ++k)
    groups[label[k]].push_back(k);
  Partition partition;
  for (const auto& group : groups)
    if (group.size() > 1)
      partition.insert(group);
  return partition;
}

const ShearingBox box{60.0, 40.0, 1.5, 0.0};

// A pile of spheres of 1 m at given adjacent positions, in rigid rotation at `spin` − 1 in the rotating frame, across
// an edge.
Patch rigid(const std::vector<Vec3>& places, double spin, double offset) {
  Patch patch = test::uniform(box, offset, places.size(), 1);
  const Vec3 centre(29.5, 19.0, 0.3);
  for (std::size_t k = 0; k < places.size(); ++k) {
    patch.positions[k] = centre + places[k];
    patch.velocities[k] = Vec3(-(spin - 1.0) * places[k].y(), (spin - 1.0) * places[k].x() - 44.0, 0.0);
    const Image home = box.image_into_cell(patch.positions[k].x(), patch.positions[k].y(), offset);
    patch.positions[k] += box.displacement(home, offset);
    patch.velocities[k].y() -= box.shear * box.size_x * home.nx;
  }
  return patch;
}

} // namespace

TEST_CASE("clusters are those of all pairs and images") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Patch patch = test::uniform(box, 3.7 * static_cast<double>(seed), 160, seed);
    for (std::size_t k = 0; k < patch.size(); ++k) {
      patch.radii[k] = 0.4 + 0.3 * static_cast<double>(k % 4);
      patch.masses[k] = std::pow(patch.radii[k], 3);
    }
    patch.positions[3] += box.displacement({1, -1}, patch.offset); // outside the cell by its eccentricity
    const std::vector<Cluster> clusters = find_clusters(patch, 0.3);
    CHECK(partition_of(clusters) == by_all_pairs(patch, 0.3));
    CHECK(clusters.size() > 5);
    for (std::size_t c = 1; c < clusters.size(); ++c)
      CHECK(clusters[c].mass <= clusters[c - 1].mass);
  }
}

TEST_CASE("shape and spin of a rigid row, cut by the corner of the box") {
  for (const double offset : {0.0, 13.0}) {
    std::vector<Vec3> row;
    for (int k = -4; k <= 4; ++k)
      row.emplace_back(1.2 * k, 1.6 * k, 0.0); // 2 m apart
    const std::vector<Cluster> clusters = find_clusters(rigid(row, 1.7, offset));
    REQUIRE(clusters.size() == 1);
    CHECK(clusters[0].members.size() == 9);
    REQUIRE(clusters[0].half_axes);
    const double along = 5.0 * (4.0 * 60.0 / 9.0 + 0.2); // Σ k² = 60
    CHECK((*clusters[0].half_axes)[0] == doctest::Approx(std::sqrt(along)).epsilon(1e-12));
    CHECK((*clusters[0].half_axes)[1] == doctest::Approx(1.0).epsilon(1e-9));
    CHECK((*clusters[0].half_axes)[2] == doctest::Approx(1.0).epsilon(1e-9));
    REQUIRE(clusters[0].spin);
    CHECK(*clusters[0].spin == doctest::Approx(1.7).epsilon(1e-10));
  }
}

TEST_CASE("a round piece of undisturbed ring spins at 1 - S/2, a vertical pile has no spin") {
  Patch ring = test::uniform(box, 0.0, 6, 1);
  for (std::size_t k = 0; k < 6; ++k) {
    const double angle = two_pi * static_cast<double>(k) / 6.0;
    ring.positions[k] = Vec3(5.0 + 2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0);
    ring.velocities[k] = Vec3(0.0, -1.5 * ring.positions[k].x(), 0.0);
  }
  const std::vector<Cluster> round = find_clusters(ring);
  REQUIRE(round.size() == 1);
  CHECK(*round[0].spin == doctest::Approx(0.25).epsilon(1e-12));

  const std::vector<Cluster> pile = find_clusters(rigid({{0, 0, -1}, {0, 0, 1}}, 2.0, 0.0));
  REQUIRE(pile.size() == 1);
  CHECK(!pile[0].spin);
  CHECK((*pile[0].half_axes)[0] == doctest::Approx(std::sqrt(6.0)).epsilon(1e-12));
}

TEST_CASE("a row that touches its own image has no end, and no shape") {
  Patch row = test::uniform(box, 7.0, 20, 1);
  for (std::size_t k = 0; k < row.size(); ++k)
    row.positions[k] = Vec3(3.0, 2.0 * static_cast<double>(k) - 19.0, 0.0);
  const std::vector<Cluster> clusters = find_clusters(row);
  REQUIRE(clusters.size() == 1);
  CHECK(clusters[0].members.size() == 20);
  CHECK(!clusters[0].half_axes);
  CHECK(!clusters[0].spin);
  row.positions[7].z() = 2.0; // broken there
  CHECK(find_clusters(row)[0].half_axes);
}

TEST_CASE("the analysis counts clusters by size") {
  Patch patch = test::uniform(box, 0.0, 10, 1); // a pair, a row of five, three alone
  for (std::size_t k = 0; k < 10; ++k)
    patch.positions[k] = Vec3(k < 2   ? -20.0
                              : k < 7 ? 0.0
                                      : 5.0 * static_cast<double>(k) - 25.0,
                              2.0 * static_cast<double>(k < 7 ? k : 0), 0.0);
  const std::vector<Patch> patches = {patch, patch};
  const ClusterAnalysis a = analyze_clusters(patches);
  CHECK(a.count == doctest::Approx(2.0));
  CHECK(a.mass_fraction == doctest::Approx(0.7));
  CHECK(a.largest_mass_fraction == doctest::Approx(0.5));
  REQUIRE(a.spectrum.size() == 2);
  CHECK(a.spectrum[0].min_members == 2);
  CHECK(a.spectrum[0].count == doctest::Approx(1.0));
  CHECK(a.spectrum[1].min_members == 4);
  CHECK(a.spectrum[1].mass_fraction == doctest::Approx(0.5));
  REQUIRE(a.largest_half_axes);
  CHECK((*a.largest_half_axes)[0] == doctest::Approx(std::sqrt(5.0 * (8.0 + 0.2))).epsilon(1e-9));
  REQUIRE(a.spin);
  CHECK(*a.spin == doctest::Approx(1.0).epsilon(1e-9)); // shear does not rotate rows along y
  CHECK(!analyze_clusters(patches, 0.0).spectrum.empty());
  CHECK(analyze_clusters(std::vector{test::uniform(box, 0.0, 1, 1)}).count == 0.0);
}

TEST_CASE("the bits do not depend on the threads") {
  const Patch patch = test::uniform(box, 11.0, 500, 1);
  set_threads(1);
  const ClusterAnalysis one = analyze_clusters({&patch, 1}, 0.1);
  set_threads(2);
  const ClusterAnalysis two = analyze_clusters({&patch, 1}, 0.1);
  CHECK(one.spin == two.spin);
  CHECK(one.largest_half_axes == two.largest_half_axes);
}

} // namespace clusters_test
