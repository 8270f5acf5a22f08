// Reference paths by themselves: they contain the true paths, and their cells find what all pairs of them find.
#include "neighbours/reference_paths.hpp"

#include "unit/collision/listed_patch.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace reference_paths_test {

using namespace keeler;
using namespace keeler::collision;
using namespace keeler::test;

namespace {

constexpr int lifetime = 10;

SearchContext context(const ListedPatch& patch) {
  return {patch.particles, patch.setting.frequencies, patch.box, patch.offset(), patch.setting.step};
}

// Distance of the true path from the nearest image of a reference path, `time` (rad) after the epoch.
double distance(const SearchContext& step, const Body& body, const Line& line, const StepInterval& life, double time) {
  const Vec3 path = state_at(body.elements, step.frequencies, Rotation(step.frequencies, time)).position;
  const double x = line.x / full_turn * step.box.size_x, y = line.y / full_turn * step.box.size_y;
  const double t = life.since_middle(step.step) + time;
  Vec3 d = path - Vec3(x + t * line.u, y + t * (line.v - step.box.shear * x), line.z + t * static_cast<double>(line.w));
  const double boxes = std::rint(d.x() / step.box.size_x);
  d.x() -= boxes * step.box.size_x;
  d.y() += boxes * (step.offset + step.box.shear * step.box.size_x * time);
  d.y() -= step.box.size_y * std::rint(d.y() / step.box.size_y);
  return d.norm();
}

std::vector<std::uint32_t> all_neighbours(const SearchContext& step, const ReferencePaths& paths, std::size_t i) {
  const std::size_t count = step.particles.size();
  std::vector<Line> lines(count + kernel_padding);
  for (std::size_t k = 0; k < count; ++k)
    lines[k] = paths.cells().line(k);
  std::vector<std::uint32_t> found(lines.size());
  std::iota(found.begin(), found.end(), 0u);
  const double half = paths.lifetime().half(step.step);
  const LineSpan rest = widened(paths.lifetime().since_middle(step.step) - 0.5 * step.step, half, half);
  found.resize(kernels(InstructionSet::portable)
                   .sweep(lines[i], lines.data(), paths.cells().frame(), rest, found.data(), count, found.data()));
  return found;
}

std::vector<std::uint32_t> neighbours(const SearchContext& step, const ReferencePaths& paths, std::size_t i) {
  std::vector<std::uint32_t> buffer;
  std::uint64_t tested = 0;
  const auto found = paths.find_neighbours(step, i, buffer, tested);
  std::vector<std::uint32_t> sorted(found.begin(), found.end());
  std::sort(sorted.begin(), sorted.end());
  CHECK(tested >= sorted.size());
  return sorted;
}

} // namespace

TEST_CASE("an undisturbed path stays within its reference path for the whole lifetime, with the skin to spare") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    ListedPatch patch({.heat = seed % 2 ? 0.1 : 1.0, .step = 0.01}, seed);
    ReferencePaths paths;
    std::vector<Line> buffer;
    REQUIRE(paths.rebuild(context(patch), lifetime, buffer));
    CHECK(paths.lifetime().length == lifetime);
    CHECK(paths.sound(patch.particles.size()));
    const double skin = 0.4; // of equal radii of 1 m
    double largest = 0.0;
    for (int step = 0; step < lifetime; ++step) {
      const SearchContext now = context(patch);
      for (std::size_t i = 0; i < patch.particles.size(); ++i)
        for (const double time : {-patch.half(), 0.0, patch.half()}) {
          const double off = distance(now, patch.particles.bodies[i], paths.line(i), paths.lifetime(), time);
          largest = std::max(largest, off - (paths.cells().line(i).size - 1.0 - skin));
        }
      patch.move_on();
      paths.begin_step();
    }
    CHECK(largest <= 1e-6);
    CHECK(paths.lifetime().over());
  }
}

TEST_CASE("the neighbours by cells are those of all pairs, also after particles got new reference paths") {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    ListedPatch patch({.count = 300, .ratio = seed % 2 ? 1.0 : 5.0, .heat = 0.2, .step = 0.01}, seed);
    const std::size_t count = patch.particles.size();
    ReferencePaths paths;
    std::vector<Line> buffer;
    REQUIRE(paths.rebuild(context(patch), lifetime, buffer));
    for (int step = 0; step < 3; ++step) {
      const SearchContext now = context(patch);
      for (std::size_t i = 0; i < count; ++i) {
        const std::vector<std::uint32_t> near = neighbours(now, paths, i);
        CHECK((near == all_neighbours(now, paths, i)));
        CHECK(std::binary_search(near.begin(), near.end(), i)); // itself
        found += near.size() - 1;
      }
      const Rotation to_middle = paths.to_middle_of_rest(now);
      for (int k = 0; k < 30; ++k) {
        const std::size_t i = patch.below(count);
        patch.change_velocity(i, 0.0, patch.random_velocity(1.0));
        CHECK(paths.renew(now, i, to_middle));
      }
      CHECK(paths.sound(count));
      patch.move_on();
      paths.begin_step();
    }
  }
  CHECK(found > 10000);
}

TEST_CASE("a particle that can reach beyond the nearest image is reported, when paths are made and later") {
  ListedPatch patch({.count = 120, .step = 0.02}, 1);
  ReferencePaths paths;
  std::vector<Line> buffer;
  REQUIRE(paths.rebuild(context(patch), lifetime, buffer));
  patch.change_velocity(7, 0.0, Vec3(patch.box.size_x / patch.setting.step, 0.0, 0.0));
  CHECK_FALSE(paths.renew(context(patch), 7, paths.to_middle_of_rest(context(patch))));
  ListedPatch fast({.count = 120, .step = 0.02}, 1);
  for (const std::size_t i : {7, 8})
    fast.change_velocity(i, 0.0, Vec3(fast.box.size_x / fast.setting.step, 0.0, 0.0));
  CHECK_FALSE(paths.rebuild(context(fast), lifetime, buffer));
}

TEST_CASE("reference paths of elements that are not finite are refused") {
  ListedPatch patch({.count = 50}, 1);
  patch.particles.bodies[40].elements.i_cos = std::numeric_limits<double>::infinity();
  ReferencePaths paths;
  std::vector<Line> buffer;
  CHECK_THROWS_AS(paths.rebuild(context(patch), lifetime, buffer), InvariantError);
}

} // namespace reference_paths_test
