// Distributed drift against the tests' plain drift, which has all particles in one list: equal bits.
#include "launched.hpp"

#include "draws.hpp"
#include "unit/collision/plain_drift.hpp"
#include "unit/collision/ring.hpp"
#include "unit/collision/same_bits.hpp"
#include "unit/collision/scenario.hpp"

#include <keeler/collision/costs.hpp>
#include <keeler/collision/drift.hpp>
#include <keeler/decomposition/blocks.hpp>
#include <keeler/finders/finders.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

using namespace keeler;
using test::Ring;
using test::Scenario;

namespace {

// A rank's part of a ring.
class Part {
public:
  Part(const Ring& ring, const collision::CollisionSettings& settings, const decomposition::Blocks::Layout& layout,
       std::size_t in_domains = 0)
      : own(ring.particles), blocks(keeler_test::launched(), ring.box, ring.frequencies, layout),
        drift(settings, ring.frequencies, test::omega, ring.step), step_(ring.step) {
    domains.count = in_domains;
    drift.observe(&domains);
    if (!keeler_test::launched().is_root())
      own.bodies.clear(), own.ids.clear(), own.spins.clear();
    blocks.distribute({own, {}});
  }

  void collide(const Ring& ring, CollisionTally& tally) {
    const double offset = ring.epoch_offset();
    const decomposition::Epoch epoch{step_ * (static_cast<double>(ring.steps) + 0.5), offset, step_};
    for (bool done = false; !done;) {
      if (!blocks.is_valid(own, epoch)) {
        drift.release();
        blocks.rebuild({own, {}}, epoch);
      }
      blocks.add_ghosts(own);
      done = drift.collide_distributed(own, blocks.ghosts(), keeler_test::launched(), ring.box, offset, tally);
      blocks.remove_ghosts(own);
      if (!done)
        blocks.widen();
    }
  }

  test::InDomains domains;
  Particles own;
  decomposition::Blocks blocks;
  collision::DriftPhase drift;

private:
  double step_;
};

// Returns the particles of `whole` that `own` contains, in its order.
Particles part_of(const Particles& whole, const Particles& own) {
  std::map<std::uint64_t, std::size_t> index_of;
  for (std::size_t k = 0; k < whole.size(); ++k)
    index_of[whole.ids[k]] = k;
  Particles part;
  part.rough = whole.rough;
  for (const std::uint64_t id : own.ids) {
    part.ids.push_back(id);
    part.bodies.push_back(whole.bodies[index_of.at(id)]);
    if (whole.rough)
      part.spins.push_back(whole.spins[index_of.at(id)]);
  }
  return part;
}

struct Walk {
  std::size_t contacts = 0;
  collision::DriftCosts costs;
  std::uint64_t rebuilds = 0, migrants = 0; // of the ghost layer
  std::size_t ghosts = 0;                   // of all ranks at the end
};

// Returns numbers of strips: the ranks' own choice (0), slabs across y (1), and blocks; strips of three ranks differ.
std::vector<std::size_t> some_strips() {
  const std::size_t ranks = keeler_test::launched().size();
  if (ranks == 2)
    return {0, 1};
  if (ranks == 3)
    return {0, 2};
  if (ranks == 4)
    return {0, 2};
  return {std::max<std::size_t>(1, ranks / 2)};
}

// Makes `steps` steps of a scenario's patch, which all ranks generate, in so many domains; 0: one for each thread.
Walk walk(const Scenario& s, std::uint64_t seed, int steps, const decomposition::Blocks::Layout& layout = {},
          std::size_t domains = 0) {
  const Communicator& ranks = keeler_test::launched();
  const collision::CollisionSettings settings = test::settings_of(s);
  Ring ring(test::make_patch(s, seed), settings, s.step);
  Part part(ring, settings, layout, domains);
  test::PlainDrift plain(settings, ring.frequencies, test::omega, ring.step);
  Walk walked;
  for (int k = 0; k < steps; ++k) {
    CollisionTally tally, expected;
    walked.contacts += plain.collide(ring.particles, ring.box, ring.epoch_offset(), expected).size();
    part.collide(ring, tally);
    INFO("step ", k);
    const bool same = test::same_bits(part.own, part_of(ring.particles, part.own));
    REQUIRE(!ranks.any(!same));
    REQUIRE(ranks.sum(part.own.size()) == s.count);
    REQUIRE(test::same_bits(tally, expected));
    ring.move_on();
    part.own = part_of(ring.particles, part.own);
  }
  walked.costs = part.drift.costs();
  walked.rebuilds = part.blocks.rebuilds();
  walked.migrants = ranks.sum(part.blocks.migrants());
  walked.ghosts = ranks.sum(part.blocks.ghosts().ghosts());
  return walked;
}

} // namespace

TEST_CASE("ranks: the same bits as the plain drift, loose and dense, for steps from 1/1000 to 1/20 orbit") {
  for (const double step : {1e-3, 5e-3, 2e-2, 5e-2})
    for (const std::size_t strips : some_strips()) {
      CAPTURE(step);
      CAPTURE(strips);
      Scenario s;
      s.step = two_pi * step;
      s.count = 150;
      CHECK(walk(s, 1 + strips, 30, {.strips = strips}).contacts > 0);
      s.count = 100;
      s.filling = 0.4, s.optical_depth = 1.2;
      CHECK(walk(s, 1 + strips, 30, {.strips = strips}).contacts > 0);
    }
}

// Without ghosts beyond the near ones, and with almost no margin, many steps are repeated. Blocks need a larger box, in
// which not all particles are near.
TEST_CASE("ranks: a step is repeated if ghosts leave their owners' paths, with the bits of the plain drift") {
  const std::size_t ranks = keeler_test::launched().size();
  for (const std::size_t strips : some_strips()) {
    const bool is_large = strips > 0;
    std::uint64_t again = 0, rounds = 0, strayed = 0, deferred = 0, again_in_domains = 0;
    for (const double step : {2e-3, 1e-2, 4e-2})
      for (const double growth : {1.0, 1.5}) {
        if (is_large && (growth > 1.0 || step > 1e-2))
          continue;
        const std::size_t domains = growth > 1.0 || (is_large && step > 5e-3) ? 4 : 0;
        CAPTURE(step);
        CAPTURE(domains);
        Scenario s;
        s.step = two_pi * step;
        s.count = is_large ? 400 : 200;
        s.filling = 0.45, s.optical_depth = is_large ? 0.7 : 1.0;
        const Walk walked =
            walk(s, 7, 25, {.growth = growth, .rows_beyond = 0.0, .strips = is_large ? strips : ranks}, domains);
        again += walked.costs.repeated_steps;
        again_in_domains += domains > 0 ? walked.costs.repeated_steps : 0;
        rounds += walked.costs.repeated_rounds;
        strayed += walked.costs.steps - 25;
        deferred += walked.costs.deferred;
      }
    MESSAGE(strips, " strips: ", again, " steps repeated in ", rounds, " rounds, ", strayed,
            " with wider ghost layers");
    if (ranks == 1)
      continue;
    CHECK(again >= (is_large ? 1 : 10));
    CHECK(again_in_domains >= (is_large ? 1 : 5));
    CHECK(keeler_test::launched().sum(deferred) > 0);
    CHECK(rounds >= again);
    CHECK((is_large || strayed >= 1));
  }
}

TEST_CASE(
    "ranks: the same bits as the plain drift, general frequencies, sizes 1:30, sticky, elastic and rough spheres") {
  Scenario s;
  s.count = 120;
  s.step = two_pi * 4e-3;
  SUBCASE("an oblate planet") {
    s.kappa = 0.986, s.nu = 1.013;
  }
  SUBCASE("sizes 1:30") {
    s.smallest = 1.0 / 30, s.count = 200;
  }
  SUBCASE("no rebound") {
    s.restitution = collision::constant_restitution(0.0),
    s.filling = test::sanitized ? 0.15 : 0.3; // a denser one collapses
  }
  SUBCASE("elastic") {
    s.restitution = collision::constant_restitution(1.0);
  }
  SUBCASE("rough spheres") {
    s.friction = {.tangential_restitution = 0.5};
  }
  const int some = test::sanitized ? 8 : 20; // steps
  CHECK(walk(s, 3, 2 * some).contacts > 20);
  CHECK(walk(s, 3, some, {}, 3).contacts > 10);
  CHECK(walk(s, 4, some, {.growth = 2.0, .rows_beyond = 0.0, .strips = some_strips().back()}).contacts > 10);
}

// In a large box most particles are no ghosts, and some move from block to block.
TEST_CASE("ranks: the bits of the plain drift in a box much larger than the ghost layer") {
  Scenario s;
  s.count = 400;
  s.step = two_pi * 2e-3;
  s.optical_depth = 0.3;
  for (const std::size_t strips : some_strips()) {
    CAPTURE(strips);
    const Walk walked = walk(s, 11, 25, {.growth = 3.0, .rows_beyond = 1.0, .strips = strips});
    CHECK(walked.contacts > 20);
    if (keeler_test::launched().distributed()) {
      CHECK(walked.ghosts > 0);
      CHECK(walked.ghosts < s.count * keeler_test::launched().size() / 2);
      CHECK(walked.migrants > 0);
    }
  }
}

TEST_CASE("ranks: a ghost layer is valid for many steps") {
  Scenario s;
  s.count = 220;
  s.optical_depth = 0.2;
  s.step = two_pi * 1e-3;
  for (const std::size_t strips : some_strips())
    CHECK(walk(s, 5, 60, {.strips = strips}).rebuilds < 30);
}

// Inexact finders are not asked about all pairs, so their twin is the drift of one process.
TEST_CASE("ranks: inexact finders have the bits of one process, in repeated steps too") {
  std::uint64_t again = 0, contacts = 0;
  for (const finders::FinderEntry& entry : finders::finder_table()) {
    CAPTURE(entry.name);
    Scenario s;
    s.step = two_pi * 1e-2;
    s.count = 150;
    s.filling = 0.4, s.optical_depth = 1.0;
    collision::CollisionSettings settings = test::settings_of(s);
    settings.finder = entry.name;
    Ring ring(test::make_patch(s, 7), settings, s.step);
    Part part(ring, settings, {.growth = 1.5, .rows_beyond = 0.0});
    collision::DriftPhase alone(settings, ring.frequencies, test::omega, ring.step);
    for (int k = 0; k < 15; ++k) {
      CollisionTally tally, expected;
      alone.collide(ring.particles, ring.box, ring.epoch_offset(), expected, false, {});
      part.collide(ring, tally);
      INFO("step ", k);
      const bool same = test::same_bits(part.own, part_of(ring.particles, part.own));
      REQUIRE(!keeler_test::launched().any(!same));
      REQUIRE(test::same_bits(tally, expected));
      CHECK(tally.gave_up == expected.gave_up);
      contacts += expected.fast + expected.slow;
      ring.move_on();
      part.own = part_of(ring.particles, part.own);
    }
    again += part.drift.costs().repeated_steps;
  }
  CHECK(contacts > 1000);
  CHECK(again >= (keeler_test::launched().distributed() ? 10 : 0));
}
