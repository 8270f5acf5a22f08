// The neighbour lists step by step against all pairs through all images, while particles drift, are hit, kicked, moved
// elsewhere, and reordered in the store. With the exact test the lists must visit exactly these pairs, each once.
#include "neighbours/neighbour_lists.hpp"

#include "draws.hpp"
#include "unit/collision/listed_patch.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace neighbour_lists_test {

using namespace keeler;
using namespace keeler::test;

TEST_CASE("at every step and after every hit the lists visit each pair that may touch once") {
  const Setting settings[] = {
      {},                                                                                  // dense and warm
      {.hits = 1.0, .kick_each = 1},                                                       // kicked at every step
      {.heat = 0.1, .step = 0.005, .hits = 0.02},                                          // long lifetimes
      {.heat = 0.1, .step = 0.005, .hits = 0.05, .kick_each = 5},                          //
      {.count = 400, .ratio = 10.0, .heat = 0.3, .hits = 0.1, .kick_each = 3},             //
      {.count = 400, .depth = 0.1, .ratio = 10.0, .heat = 3.0, .step = 0.03, .hits = 0.0}, // no hits
      {.depth = 1.0, .heat = 0.1, .step = 0.004, .hits = 0.01, .speed = 30.0}, // a hit particle leaves its skin later
      {.depth = 1.0, .heat = 0.1, .step = 0.02, .hits = 0.02, .speed = 30.0},  // or within the step
      {.depth = 0.2, .heat = 0.5, .step = 0.1, .elongation = 2.0, .frequencies = {0.8, 2.5}},
      {.count = 300, .depth = 0.5, .heat = 0.05, .step = 0.01, .elongation = 0.3, .hits = 0.3},
  };
  Seen seen;
  std::uint64_t rebuilds = 0, renewed = 0;
  const std::uint64_t seeds = test::sanitized ? 1 : 2;
  for (std::size_t s = 0; s < std::size(settings); ++s)
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      CAPTURE(s);
      CAPTURE(seed);
      ListedPatch patch(settings[s], seed);
      drift(patch, 48, seen);
      rebuilds += patch.lists.counts().rebuilds;
      renewed += patch.lists.counts().renewed;
    }
  MESSAGE(seen.pairs << " pairs at begins (" << seen.more << " not exactly) and " << seen.partners << " partners in "
                     << seen.steps << " steps; " << rebuilds << " rebuilds, " << renewed << " lists renewed");
  CHECK(seen.pairs > 40000 * seeds);
  CHECK(seen.partners > 10000 * seeds);
  CHECK(rebuilds < seen.steps / 3);
  CHECK(renewed > 600 * seeds);
}

namespace {

// Changes of a patch besides drift, hits and kicks; after each one the step is not undisturbed.
void reorder(ListedPatch& patch, std::size_t swaps) {
  for (std::size_t k = 0; k < swaps; ++k) {
    const std::size_t a = patch.below(patch.particles.size()), b = patch.below(patch.particles.size());
    std::swap(patch.particles.bodies[a], patch.particles.bodies[b]);
    std::swap(patch.particles.ids[a], patch.particles.ids[b]);
  }
}

void move_elsewhere(ListedPatch& patch, std::size_t number) {
  for (std::size_t k = 0; k < number; ++k) {
    Elements& el = patch.particles.bodies[patch.below(patch.particles.size())].elements;
    el.guiding_x = patch.centred(patch.box.size_x);
    el.guiding_y = patch.centred(patch.box.size_y);
  }
}

void grow(ListedPatch& patch, std::size_t number) {
  for (std::size_t k = 0; k < number; ++k)
    patch.particles.bodies[patch.below(patch.particles.size())].radius *= 1.7;
}

// Adds particles, or removes some.
void replace_some(ListedPatch& patch, std::size_t number) {
  Particles& particles = patch.particles;
  for (std::size_t k = 0; k < number; ++k)
    if (particles.size() > patch.setting.count) {
      particles.bodies.pop_back();
      particles.ids.pop_back();
    } else {
      particles.bodies.push_back(particles.bodies[patch.below(particles.size())]);
      particles.bodies.back().elements.guiding_y = patch.centred(patch.box.size_y);
      particles.ids.push_back(particles.ids.back() + 1);
    }
}

} // namespace

TEST_CASE("particles that are moved, grow, are reordered, added or removed between steps are found") {
  Seen seen;
  std::uint64_t rebuilds = 0, renewed = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(16); ++seed) {
    CAPTURE(seed);
    ListedPatch patch({.count = 200, .ratio = seed % 2 ? 1.0 : 10.0, .heat = 0.3, .step = 0.01, .hits = 0.05}, seed);
    for (int change = 0; change < 20; ++change) {
      CAPTURE(change);
      drift(patch, 2, seen);
      const std::size_t number = patch.below(4) ? 1 + patch.below(3) : 300; // a few, or nearly all
      switch (patch.below(5)) {
      case 0:
        reorder(patch, number);
        break;
      case 1:
        move_elsewhere(patch, number);
        break;
      case 2:
        grow(patch, std::min<std::size_t>(number, 3));
        break;
      case 3:
        replace_some(patch, std::min<std::size_t>(number, 9));
        break;
      default:
        patch.steps += static_cast<std::int64_t>(patch.below(3)); // another shear offset
      }
      patch.undisturbed = false;
    }
    rebuilds += patch.lists.counts().rebuilds;
    renewed += patch.lists.counts().renewed;
  }
  MESSAGE(seen.steps << " steps, " << rebuilds << " rebuilds, " << renewed << " lists renewed");
  CHECK(seen.pairs > test::draws(10000));
  CHECK(rebuilds < seen.steps * 3 / 4);
  CHECK(renewed > test::draws(300));
}

TEST_CASE("a hit that changes nothing rebuilds no list, also at an edge of the box") {
  ListedPatch patch({.count = 200, .heat = 0.5, .step = 0.01, .hits = 0.0}, 1);
  Seen seen;
  for (int step = 0; step < 40; ++step) {
    drift(patch, 1, seen);
    REQUIRE(patch.begin());
    const std::uint64_t before = patch.lists.counts().renewed;
    for (std::size_t i = 0; i < patch.particles.size(); ++i)
      patch.hit(i, patch.centred(patch.setting.step), 0.0);
    CHECK(patch.lists.counts().renewed == before);
    std::vector<std::uint32_t> hit(patch.particles.size());
    std::iota(hit.begin(), hit.end(), 0u);
    patch.lists.mark_dirty(hit);
    patch.move_on();
  }
}

TEST_CASE("when particles are removed, so is what was noted about their next steps") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    ListedPatch patch({.count = 200, .heat = 0.01, .step = 0.005, .hits = 0.0}, seed);
    Seen seen;
    drift(patch, 9, seen); // pruning intervals have several steps
    REQUIRE(patch.begin());
    const std::uint32_t last[] = {199};
    patch.hit(last[0], 0.0, 50.0); // leaves its skin some steps later
    patch.lists.mark_dirty(last);
    patch.move_on();
    patch.particles.bodies.resize(100);
    patch.particles.ids.resize(100);
    patch.undisturbed = false;
    const std::uint64_t before = patch.lists.counts().renewed;
    drift(patch, 3, seen);
    CHECK(patch.lists.counts().renewed == before);
  }
}

TEST_CASE("thousands of particles have the same lists and pairs for any number of threads") {
  const int before = threads();
  std::size_t pairs = 0;
  for (const double ratio : {1.0, 10.0}) {
    const Setting setting{.count = 3500, .ratio = ratio, .heat = 0.5, .hits = 0.02, .kick_each = 3};
    ListedPatch one(setting, 1), three(setting, 1);
    for (int step = 0; step < 10; ++step) {
      CAPTURE(step);
      set_threads(1);
      REQUIRE(one.begin());
      set_threads(3);
      REQUIRE(three.begin());
      const std::vector<FoundPair> found = one.visited(one.lists);
      CHECK((three.visited(three.lists) == found));
      pairs += found.size();
      if (step == 4 && !test::sanitized)
        CHECK((one.all_pairs() == found));
      std::size_t different = 0;
      for (std::size_t i = 0; i < setting.count; ++i)
        different += !std::is_permutation(one.lists.list(i).begin(), one.lists.list(i).end(),
                                          three.lists.list(i).begin(), three.lists.list(i).end());
      CHECK(different == 0);
      Seen seen;
      for (ListedPatch* patch : {&one, &three}) {
        hit_some(*patch, seen);
        patch->move_on();
        if (step % 3 == 2)
          kick_all(*patch);
      }
    }
    CHECK(one.lists.counts().rebuilds == three.lists.counts().rebuilds);
    CHECK(one.lists.counts().renewed == three.lists.counts().renewed);
  }
  set_threads(before);
  CHECK(pairs > 20000);
}

TEST_CASE("a particle so fast that it may meet others through several images is searched through all images") {
  ListedPatch patch({.count = 120, .step = 0.05, .hits = 0.1}, 1);
  Seen seen;
  drift(patch, 3, seen);
  REQUIRE(patch.begin());
  CHECK_FALSE(patch.lists.reaches_far());
  patch.hit(7, 0.0, 24.0 * patch.box.size_x / patch.setting.step);
  CHECK(patch.lists.reaches_far());
  std::size_t partners = 0, through_several = 0;
  for (const std::size_t i : {std::size_t{7}, std::size_t{3}, std::size_t{100}}) {
    const std::vector<FoundPair> expected = patch.all_partners(i, 0.0, 30);
    CHECK((patch.visited_partners(i, 0.0) == expected));
    partners += expected.size();
    for (std::size_t k = 1; k < expected.size(); ++k)
      through_several += std::get<0>(expected[k]) == std::get<0>(expected[k - 1]) &&
                         std::get<1>(expected[k]) == std::get<1>(expected[k - 1]);
  }
  CHECK(partners > 20);
  CHECK(through_several > 0);
  const std::uint32_t hit[] = {7};
  patch.lists.mark_dirty(hit);
  patch.move_on();
  CHECK_FALSE(patch.begin()); // the lists are not valid in the next step either
  patch.change_velocity(7, -patch.half(), -0.9999 * patch.state_velocity(7));
  patch.undisturbed = false;
  REQUIRE(patch.begin());
  check_begin(patch, seen);
}

TEST_CASE("when a particle gets too fast for the lifetime of the lists, all are rebuilt for the step alone") {
  ListedPatch patch({.count = 400, .step = 0.05, .hits = 0.1}, 1);
  Seen seen;
  drift(patch, 3, seen);
  REQUIRE(patch.begin());
  const std::uint64_t rebuilds = patch.lists.counts().rebuilds;
  patch.hit(7, 0.0, 0.1 * patch.box.size_x / patch.setting.step);
  CHECK(patch.lists.counts().rebuilds == rebuilds + 1);
  REQUIRE_FALSE(patch.lists.reaches_far());
  std::size_t partners = 0;
  for (std::size_t i = 0; i < patch.particles.size(); ++i) {
    const std::vector<FoundPair> expected = patch.all_partners(i, 0.0, 1);
    CHECK((patch.visited_partners(i, 0.0) == expected));
    partners += expected.size();
  }
  CHECK(partners > 20);
  const std::uint32_t hit[] = {7};
  patch.lists.mark_dirty(hit);
  patch.move_on();
  REQUIRE(patch.begin()); // with a shorter lifetime
  CHECK(patch.lists.counts().rebuilds == rebuilds + 2);
  drift(patch, 10, seen);
}

TEST_CASE("in a box so large that positions are rounded by more than the skin, neighbours are found") {
  ListedPatch patch({.count = 60, .depth = 2e-16, .hits = 0.2}, 1);
  for (Body& body : patch.particles.bodies) { // a clump
    body.elements.guiding_x = patch.centred(20.0);
    body.elements.guiding_y = patch.centred(20.0);
  }
  Seen seen;
  drift(patch, 20, seen);
  CHECK(seen.pairs > 200);
}

TEST_CASE("elements that are not finite are refused, when the lists are built and later") {
  for (const int steps : {0, 1, 3}) {
    ListedPatch patch({.count = 100}, 1);
    Seen seen;
    drift(patch, steps, seen);
    patch.particles.bodies[40].elements.e_sin = std::numeric_limits<double>::quiet_NaN();
    patch.undisturbed = false;
    CHECK_THROWS_AS(patch.begin(), InvariantError);
  }
}

// Also if paths go on undisturbed.
TEST_CASE("an interval and lists that are released leave their memory, and are made again") {
  ListedPatch patch({.count = 1000, .heat = 0.1, .step = 0.005, .hits = 0.01}, 1);
  Seen seen;
  drift(patch, 2, seen);
  const std::size_t whole = patch.lists.bytes(), count = patch.particles.size();
  REQUIRE(patch.undisturbed);
  patch.lists.release_interval();
  const std::size_t without_interval = patch.lists.bytes();
  CHECK(without_interval <= whole - count * sizeof(collision::Line));
  drift(patch, 2, seen);
  CHECK(patch.lists.counts().rebuilds == 1);
  patch.lists.release();
  CHECK(patch.lists.bytes() < without_interval / 2);
  drift(patch, 2, seen);
  CHECK(patch.lists.counts().rebuilds == 2);
}

TEST_CASE("no particle, or a single one, has no pairs") {
  for (const std::size_t count : {0, 1}) {
    ListedPatch patch({.count = 100}, 1);
    patch.particles.bodies.resize(count);
    patch.particles.ids.resize(count);
    for (int step = 0; step < 20; ++step) {
      REQUIRE(patch.begin());
      CHECK(patch.visited(patch.lists).empty());
      for (std::size_t i = 0; i < count; ++i)
        CHECK(patch.visited_partners(i, 0.0).empty());
      patch.lists.mark_dirty({});
      patch.move_on();
    }
  }
}

} // namespace neighbour_lists_test
