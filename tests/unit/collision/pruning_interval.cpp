// The pruning interval by itself: its pairs against all pairs step by step, and the particles that leave their skin.
#include "neighbours/pruning_interval.hpp"

#include "unit/collision/listed_patch.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace pruning_interval_test {

using namespace keeler;
using namespace keeler::collision;
using namespace keeler::test;

namespace {

// Lists for 20 steps and an interval of 5 at their begin.
struct Pruned {
  ListedPatch patch;
  ReferencePaths paths;
  VerletList lists;
  PruningInterval interval;
  ListRebuild built;

  Pruned(const Setting& setting, std::uint64_t seed) : patch(setting, seed) {
    REQUIRE(paths.rebuild(context(), 20, interval.buffer()));
    built = rebuild_lists(paths.cells(), paths.lifetime().half(setting.step), lists);
    begin(5);
  }
  std::vector<std::uint32_t> begin(int steps) {
    const std::vector<std::uint32_t> escaped = interval.begin(context(), steps, paths);
    interval.prune(lists, patch.setting.step);
    return escaped;
  }
  SearchContext context() const {
    return {patch.particles, patch.setting.frequencies, patch.box, patch.offset(), patch.setting.step};
  }
  std::set<std::pair<std::size_t, std::size_t>> pruned() const {
    std::set<std::pair<std::size_t, std::size_t>> all;
    for (std::size_t block = 0; block < interval.pair_blocks(); ++block)
      for (std::size_t k = 0; k < pair_count(interval.pairs(block)); ++k) {
        const auto [first, second] = interval.pairs(block)[k];
        CHECK(all.insert(std::minmax<std::size_t>(first, second)).second);
      }
    return all;
  }
  void next_step() {
    patch.move_on();
    paths.begin_step();
    interval.begin_step();
    if (!interval.steps().over())
      interval.look_ahead(context());
  }
  std::size_t count() const { return patch.particles.size(); }
};

} // namespace

TEST_CASE("pruned pairs are listed pairs, each once, and contain every pair that may touch in the interval") {
  std::size_t touching = 0, pruned_pairs = 0, listed = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    Pruned all({.ratio = seed % 2 ? 1.0 : 5.0, .heat = 0.3, .step = 0.01}, seed);
    CHECK(all.lists.sound());
    CHECK(all.interval.sound(all.count()));
    const auto pruned = all.pruned();
    for (const auto& [i, j] : pruned)
      CHECK(std::ranges::count(all.lists.list(i), j) == 1);
    for (int step = 0; step < 5; ++step) {
      CHECK_FALSE(all.interval.steps().over());
      for (std::size_t i = 0; i < all.count(); ++i)
        for (std::size_t j = i + 1; j < all.count(); ++j) {
          const SearchContext now = all.context();
          const Image image = now.nearest_image(all.patch.particles.bodies[i], all.patch.particles.bodies[j]);
          if (!now.may_touch(i, j, image, -all.patch.half()))
            continue;
          ++touching;
          if (!pruned.contains({i, j}))
            CHECK(pruned.contains({i, j}));
        }
      all.next_step();
    }
    CHECK(all.interval.steps().over());
    pruned_pairs += pruned.size();
    listed += all.built.entries / 2;
  }
  CHECK(touching > 500);
  CHECK(pruned_pairs < listed);
}

TEST_CASE("a hit that leaves the skin is reported: within the step at once, later when the step ends") {
  Pruned all({.heat = 0.1, .step = 0.01, .hits = 0.0}, 1);
  const double speeds[] = {0.0, 0.4 / 0.025, 100.0}; // the skin: 0.4 m; two steps and a half: 0.025 rad
  for (const std::uint32_t i : {0u, 1u, 2u}) {
    all.patch.change_velocity(i, 0.0, Vec3(0.0, 0.0, speeds[i]));
    CHECK(all.interval.follow_hit(all.context(), i, 0.0, all.paths.line(i)) == (i < 2));
    all.interval.mark_dirty(i);
  }
  CHECK(all.interval.dirty().size() == 3);
  CHECK(std::ranges::equal(all.interval.escaped(), std::vector<std::uint32_t>{1, 2}));
  CHECK(all.interval.sound(all.count()));
  all.interval.clear_escaped();
  CHECK(all.interval.escaped().empty());
  all.next_step();
  CHECK((all.begin(5) == std::vector<std::uint32_t>{1, 2})); // all are looked at again
  CHECK(all.interval.dirty().empty());
}

TEST_CASE("of a particle whose list was rebuilt by itself, the whole list is pruned") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    Pruned all({.heat = 0.1, .step = 0.01}, seed);
    const auto before = all.pruned();
    std::vector<std::uint32_t> buffer;
    std::uint64_t tested = 0;
    const SearchContext now = all.context();
    for (std::uint32_t i = 0; i < 100; ++i) { // not moved, so the pairs are those of before
      REQUIRE(all.paths.renew(now, i, all.paths.to_middle_of_rest(now)));
      all.lists.replace(i, all.paths.find_neighbours(now, i, buffer, tested));
    }
    all.begin(5);
    CHECK((all.pruned() == before));
  }
}

} // namespace pruning_interval_test
