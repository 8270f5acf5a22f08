#include <keeler/initial_conditions/tiled.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tiled_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

const std::vector<std::pair<std::size_t, std::size_t>> tilings = {{2, 2}, {3, 2}, {1, 4}, {4, 1}, {3, 3}};

// Neither a factor of the sides nor kappa is 1.
Scene scene_of(std::size_t count) {
  return parse_scene(fmt::format(R"(
[planet]
orbital_frequency = 1.95e-4
epicyclic_ratio = 0.9
vertical_ratio = 1.3
[box]
size = [21, 26]
[particles]
count = {}
density = 900.0
sizes = {{ law = "power", exponent = 3.0, min = 0.5, max = 2.0 }}
[collisions]
restitution = {{ law = "constant", value = 0.5 }}
[time]
end = 1.0
)",
                                 count),
                     "test scene");
}

// A patch in a sheared box, with motion from a few collisions.
Patch evolved(const Scene& scene) {
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < 131; ++k)
    simulation.advance();
  return simulation.patch();
}

// Returns the sorted distances from a particle to all images of particles within a reach.
std::vector<double> distances(const Patch& patch, std::size_t k, double reach) {
  std::vector<double> all;
  const int nx_most = static_cast<int>(reach / patch.box.size_x) + 2, ny_most = 2 * nx_most + 4;
  for (std::size_t other = 0; other < patch.size(); ++other)
    for (int nx = -nx_most; nx <= nx_most; ++nx)
      for (int ny = -ny_most; ny <= ny_most; ++ny) {
        const Vec3 d = patch.positions[other] + patch.box.displacement({nx, ny}, patch.offset) - patch.positions[k];
        if (d.norm() < reach)
          all.push_back(d.norm());
      }
  std::sort(all.begin(), all.end());
  return all;
}

} // namespace

TEST_CASE("all distances of a tiled patch are those of the patch, across the new edges too") {
  const Patch patch = evolved(scene_of(24));
  REQUIRE(patch.offset > 1.0); // else it tests little
  constexpr double reach = 40.0;
  const double drift = patch.box.shear * 0.5 * patch.box.size_x * 0.5 * scene_of(24).step_length();
  for (const auto& tiling : tilings) {
    const Patch large = tiled_patch(patch, tiling.first, tiling.second);
    REQUIRE(large.size() == patch.size() * tiling.first * tiling.second);
    CHECK(large.box.size_x == static_cast<double>(tiling.first) * patch.box.size_x);
    CHECK(large.box.size_y == static_cast<double>(tiling.second) * patch.box.size_y);
    CHECK(cells::largest_overlap(large).depth < 1e-12);
    double worst = 0.0;
    std::size_t of_another_number = 0, outside = 0;
    for (std::size_t k = 0; k < large.size(); ++k) {
      const std::vector<double> expected = distances(patch, k % patch.size(), reach),
                                found = distances(large, k, reach);
      of_another_number += found.size() != expected.size();
      for (std::size_t d = 0; d < std::min(found.size(), expected.size()); ++d)
        worst = std::max(worst, std::fabs(found[d] - expected[d]));
      const Elements el = elements_from({large.positions[k], large.velocities[k]}, large.frequencies, Rotation());
      outside +=
          std::fabs(el.guiding_x) > 0.5 * large.box.size_x || std::fabs(el.guiding_y) > 0.5 * large.box.size_y + drift;
    }
    CHECK(of_another_number == 0);
    CHECK(outside == 0);
    CHECK(worst < 1e-13 * 100.0); // a few roundings of positions up to 100 m
  }
}

TEST_CASE("each copy keeps the motion of the patch until rounding grows") {
  const Scene scene = scene_of(60);
  const Patch patch = evolved(scene);
  for (const auto& tiling : tilings) {
    const Patch large = tiled_patch(patch, tiling.first, tiling.second);
    Simulation one(scene, patch), many(scene, large);
    for (int k = 0; k < 110; ++k) {
      one.advance();
      many.advance();
    }
    CHECK(one.state().collisions.fast > 20);
    CHECK(many.state().collisions.fast == one.state().collisions.fast * tiling.first * tiling.second);
    const Patch small = one.patch(), all = many.patch();
    double worst = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::size_t particle = k % small.size();
      worst = std::max(
          worst, (diagnostics::peculiar_velocity(all, k) - diagnostics::peculiar_velocity(small, particle)).norm());
      worst = std::max(worst, std::fabs(all.positions[k].z() - small.positions[particle].z()));
    }
    CHECK(worst < 1e-9); // of motions of 1 m/rad: a collision multiplies an error of 1e-14 by about ten
  }
}

TEST_CASE("copies keep radii and masses, and get ids by the rule") {
  Patch patch = evolved(scene_of(24));
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.ids[k] = 3 + 5 * k; // the last one has 118
  const Patch large = tiled_patch(patch, 2, 3);
  for (std::size_t k = 0; k < large.size(); ++k) {
    CHECK(large.ids[k] == patch.ids[k % 24] + 119 * (k / 24));
    CHECK(large.radii[k] == patch.radii[k % 24]);
    CHECK(large.masses[k] == patch.masses[k % 24]);
  }
  CHECK(diagnostics::optical_depth(large) == doctest::Approx(diagnostics::optical_depth(patch)).epsilon(1e-12));
}

TEST_CASE("one copy is the patch") {
  const Patch patch = evolved(scene_of(60)), same = tiled_patch(patch, 1, 1);
  CHECK(same.positions == patch.positions);
  CHECK(same.velocities == patch.velocities);
  CHECK(same.ids == patch.ids);
  CHECK(same.offset == patch.offset);
  CHECK(same.box.first_offset == patch.offset);
  CHECK(same.time_orbits == 0.0);
}

TEST_CASE("a tiled patch comes the same some particles at a time") {
  Patch patch = evolved(scene_of(24));
  for (const bool rough : {false, true}) {
    if (rough)
      patch.spins.assign(patch.size(), Vec3(0.1, -1.0, 0.5));
    const TiledPatch tiled(patch, 3, 2);
    const Patch whole = tiled_patch(patch, 3, 2);
    CHECK(tiled.size() == whole.size());
    CHECK(tiled.rough() == rough);
    for (std::size_t first = 0; first < tiled.size(); first += 17) { // across copies
      const std::size_t count = std::min<std::size_t>(17, tiled.size() - first);
      const Patch some = tiled.some(first, count);
      REQUIRE(some.size() == count);
      CHECK(some.offset == whole.offset);
      CHECK(some.box.size_x == whole.box.size_x);
      for (std::size_t k = 0; k < count; ++k) {
        CHECK(some.positions[k] == whole.positions[first + k]);
        CHECK(some.velocities[k] == whole.velocities[first + k]);
        CHECK(some.ids[k] == whole.ids[first + k]);
        CHECK((!rough || some.spins[k] == whole.spins[first + k]));
      }
    }
  }
}

TEST_CASE("a tiled patch must be one that a run takes") {
  Patch patch = evolved(scene_of(24));
  const auto fault = [&](std::size_t nx, std::size_t ny) {
    try {
      tiled_patch(patch, nx, ny);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(fault(1, 1000).find("21 m x 26000 m, more than 1000 times as long as wide") != std::string::npos);
  CHECK(fault(10000, 10000).find("2.4e9 particles (the limit is 1e9)") != std::string::npos);
  patch.ids.back() = std::uint64_t{1} << 62;
  CHECK(fault(2, 2).find("leave no ids for the copies") != std::string::npos);
  patch.box.size_x = patch.box.size_y = 2e6;
  CHECK(fault(10, 1).find("2e7 m x 2000000 m (a patch has sizes above 0 and at most 1e7)") != std::string::npos);
}

TEST_CASE("copies of rough particles spin as these do") {
  Patch patch = evolved(scene_of(30));
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.spins.push_back({0.1 * static_cast<double>(k), -1.0, 0.5});
  const Patch tiled = tiled_patch(patch, 2, 3);
  REQUIRE(tiled.spins.size() == 6 * patch.size());
  for (std::size_t k = 0; k < tiled.size(); ++k)
    CHECK(tiled.spins[k] == patch.spins[k % patch.size()]);
}

} // namespace tiled_test
