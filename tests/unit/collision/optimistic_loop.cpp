// The optimistic loop against the sequential one, in any number of domains, on one thread and on several: equal bits,
// with every part of the algorithm in use.
#include "draws.hpp"
#include "unit/collision/ring.hpp"
#include <keeler/collision/costs.hpp>

#include "unit/collision/twin.hpp"

#include <doctest/doctest.h>

namespace optimistic_loop_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

struct Domains final : DriftObserver {
  explicit Domains(std::size_t how_many) : count(how_many) {}
  bool wants_events() const override { return false; }
  std::size_t wants_domains() const override { return count; }
  bool wants_records() const override { return true; }
  void recorded(std::span<const CollisionRecord> of_step) override {
    records.insert(records.end(), of_step.begin(), of_step.end());
  }
  std::size_t count;
  std::vector<CollisionRecord> records;
};

struct End {
  Particles particles;
  CollisionTally tally;
  DriftCosts costs;
  std::vector<CollisionRecord> records;
};

End drift(const Patch& patch, const CollisionSettings& settings, double step, int steps, std::size_t domains) {
  test::Ring ring(patch, settings, step);
  ring.keeps_neighbours = true;
  Domains wanted(domains); // one domain: in sequence
  ring.observer = &wanted;
  for (int k = 0; k < steps; ++k) {
    ring.advance();
    if (k % 4 == 3)
      ring.kick_all(0.05);
  }
  return {ring.particles, ring.tally, ring.drift.costs(), wanted.records};
}

} // namespace

TEST_CASE("domains carry out, defer and roll back what the sequence carries out") {
  const int before = threads();
  std::uint64_t deferred = 0, in_sequence = 0, rolled_back = 0, contacts = 0, abandoned = 0, steps = 0;
  for (std::uint64_t seed = 1; seed <= (test::sanitized ? 3 : 6); ++seed) {
    test::Scenario s;
    s.count = 1500;
    s.filling = seed % 2 ? 0.35 : 0.2;
    s.smallest = seed % 3 ? 1.0 : 0.3;
    s.step = two_pi * (seed % 2 ? 1e-2 : 2e-2);
    const Patch patch = test::make_patch(s, seed);
    set_threads(1);
    const End expected = drift(patch, test::settings_of(s), s.step, 10, 1);
    CHECK(expected.costs.deferred == 0);
    for (const int several : {1, 3})
      for (const std::size_t domains : {2, 3, 6, 9, 40, 200}) {
        CAPTURE(seed);
        CAPTURE(several);
        CAPTURE(domains);
        set_threads(several);
        const End end = drift(patch, test::settings_of(s), s.step, 10, domains);
        CHECK(test::same_bits(end.particles, expected.particles));
        CHECK(test::same_bits(end.tally, expected.tally));
        CHECK(end.costs.contacts == expected.costs.contacts);
        CHECK(end.records.size() == end.costs.contacts);
        CHECK(test::same_records(end.records, expected.records) == expected.records.size());
        contacts += end.costs.contacts;
        deferred += end.costs.deferred;
        in_sequence += end.costs.in_sequence;
        rolled_back += end.costs.rolled_back;
        abandoned += end.costs.abandoned;
        steps += 10;
      }
  }
  set_threads(before);
  MESSAGE(contacts << " contacts; events deferred " << deferred << ", left to the last round " << in_sequence
                   << "; contacts rolled back " << rolled_back << "; of " << steps << " steps left to the sequence "
                   << abandoned);
  CHECK(contacts > 20000);
  CHECK(deferred > 1000);
  CHECK(in_sequence > 100);
  CHECK(rolled_back > 100);
  CHECK(abandoned == 0);
}

TEST_CASE("paths that a domain leaves are taken up by later rounds") {
  const int before = threads();
  test::Scenario s;
  s.count = 9000; // of a small patch domains leave none in most steps
  s.filling = 0.35;
  s.step = two_pi * 2e-2;
  const Patch patch = test::make_patch(s, 1);
  set_threads(1);
  const End expected = drift(patch, test::settings_of(s), s.step, 4, 1);
  for (const std::size_t domains : {9, 40, 200}) {
    CAPTURE(domains);
    set_threads(3);
    const End end = drift(patch, test::settings_of(s), s.step, 4, domains);
    CHECK(test::same_bits(end.particles, expected.particles));
    CHECK(test::same_bits(end.tally, expected.tally));
    CHECK(end.costs.rolled_back > 0);
    CHECK(end.costs.abandoned == 0);
  }
  set_threads(before);
}

TEST_CASE("what domains did is the same for any number of threads") {
  const int before = threads();
  test::Scenario s;
  s.count = 2000;
  s.filling = 0.3;
  s.step = two_pi * 1e-2;
  const Patch patch = test::make_patch(s, 9);
  set_threads(1);
  const DriftCosts one = drift(patch, test::settings_of(s), s.step, 8, 4).costs;
  CHECK(one.deferred > 0);
  for (const int several : {2, 4}) {
    set_threads(several);
    const DriftCosts costs = drift(patch, test::settings_of(s), s.step, 8, 4).costs;
    CHECK(costs.deferred == one.deferred);
    CHECK(costs.in_sequence == one.in_sequence);
    CHECK(costs.rolled_back == one.rolled_back);
  }
  set_threads(before);
}

} // namespace optimistic_loop_test
