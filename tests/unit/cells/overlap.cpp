#include <keeler/cells/overlap.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

namespace overlap_test {

using namespace keeler;
using namespace keeler::cells;

namespace {

Patch random_patch(std::uint64_t seed, int count) {
  RandomStream random(seed, RandomPurpose::position, 0);
  Patch patch;
  patch.box = {20.0, 30.0, 1.5, 0.0};
  patch.offset = random.uniform() * 30.0;
  for (int k = 0; k < count; ++k) {
    patch.positions.emplace_back(22.0 * (random.uniform() - 0.5), 32.0 * (random.uniform() - 0.5), random.normal());
    patch.velocities.push_back(Vec3::Zero());
    patch.radii.push_back(0.2 + 0.8 * random.uniform());
    patch.masses.push_back(1.0);
    patch.ids.push_back(k);
  }
  return patch;
}

} // namespace

TEST_CASE("the largest overlap is that of all pairs and images") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Patch patch = random_patch(seed, 40);
    if (seed % 2 == 0)
      patch.radii[seed] = 6.0; // a giant among them
    double deepest = 0.0;
    for (std::size_t i = 0; i < patch.size(); ++i)
      for (std::size_t j = i + 1; j < patch.size(); ++j)
        for (int nx = -2; nx <= 2; ++nx)
          for (int ny = -3; ny <= 3; ++ny) {
            const Vec3 d = patch.positions[j] + patch.box.displacement({nx, ny}, patch.offset) - patch.positions[i];
            const double sum = patch.radii[i] + patch.radii[j];
            deepest = std::max(deepest, (sum - d.norm()) / sum);
          }
    CHECK(largest_overlap(patch).depth == deepest);
  }
  CHECK(largest_overlap(Patch{}).depth == 0.0);
}

} // namespace overlap_test
