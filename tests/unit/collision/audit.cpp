// The audit of the broad phase: lists and grid miss no neighbour, at the begin of steps and after hits; and a missed
// neighbour is reported.
#include "plain_search.hpp"
#include "unit/collision/ring.hpp"
#include "unit/collision/same_bits.hpp"

#include <keeler/collision/neighbour_audit.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

namespace audit_test {

using namespace keeler;
using namespace keeler::collision;
using namespace keeler::test;

TEST_CASE("no neighbour is missed: lists or grid, kept or made anew, on one thread or several; no bit changes") {
  const int before = threads();
  std::uint64_t pairs = 0, contacts = 0;
  for (const Scenario& s : {Scenario{}, Scenario{.count = 6, .step = 0.1}, Scenario{.count = 300, .smallest = 0.2},
                            Scenario{.count = 300, .optical_depth = 1.5, .kappa = 0.8, .nu = 3.0}})
    for (const int several : {1, 3})
      for (const bool keeps : {false, true}) {
        set_threads(several);
        Ring ring(make_patch(s, 2), settings_of(s), s.step), plain(make_patch(s, 2), settings_of(s), s.step);
        ring.keeps_neighbours = plain.keeps_neighbours = keeps;
        NeighbourAudit audit;
        ring.drift.audit(&audit);
        for (int step = 0; step < 40; ++step) {
          ring.advance();
          plain.advance();
          if (step % 7 == 6) {
            ring.kick_all(0.1);
            plain.kick_all(0.1);
          }
        }
        CHECK(audit.steps == 40);
        CHECK_FALSE(audit.missed.has_value());
        CHECK(same_bits(ring.particles, plain.particles));
        pairs += audit.pairs;
        contacts += ring.tally.fast;
      }
  set_threads(before);
  MESSAGE(pairs << " pairs that must not be missed, " << contacts << " contacts");
  CHECK(pairs > 2000);
  CHECK(contacts > 500);
}

// Within a pruning interval of several steps lists rely on it that only particles that were hit have changed their
// path.
TEST_CASE("lists that were kept although particles have moved elsewhere: the audit tells who is missed") {
  const Scenario s{.count = 300, .step = two_pi * 1e-4};
  int told = 0;
  for (int steps = 1; steps < 12; ++steps) {
    Ring ring(make_patch(s, 1), settings_of(s), s.step);
    ring.keeps_neighbours = true;
    NeighbourAudit audit;
    audit.particles = 300;
    ring.drift.audit(&audit);
    for (int step = 0; step < steps; ++step)
      ring.advance();
    REQUIRE_FALSE(audit.missed.has_value());
    for (std::size_t k = 0; k + 1 < s.count; k += 2) { // every second one moves close to the next, without notice
      const Body& other = ring.particles.bodies[k + 1];
      Body& moved = ring.particles.bodies[k];
      moved.elements = other.elements;
      moved.elements.guiding_y += moved.radius + other.radius;
    }
    REQUIRE(ring.undisturbed);
    ring.advance();
    if (!audit.missed)
      continue; // a pruning interval began
    ++told;
    CHECK(audit.missed->id != audit.missed->other_id);
    CHECK(audit.missed->distance < 2.0);
  }
  CHECK(told > 3);
}

TEST_CASE("the plain search rules nobody out by the guiding centre of whom an image comes near") {
  constexpr double size_x = 50.0, allowance = 0.1;
  RandomStream random(3, RandomPurpose::sample, 0);
  const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const auto body = [&] {
    Body b;
    b.elements.guiding_x = draw(-60.0, 60.0); // outside the cell too, as hits may carry it
    b.elements.e_cos = draw(-4.0, 4.0);
    b.elements.e_sin = draw(-4.0, 4.0);
    b.radius = draw(0.1, 3.0);
    return b;
  };
  int ruled_out = 0, near = 0;
  for (int k = 0; k < 20000; ++k) {
    const Body a = body(), b = body();
    const double x = b.elements.guiding_x - a.elements.guiding_x,
                 reach = a.radius + b.radius + allowance + a.elements.eccentricity() + b.elements.eccentricity();
    bool comes_near = false;
    for (int nx = -4; nx <= 4; ++nx)
      comes_near |= std::fabs(x + nx * size_x) <= reach;
    near += comes_near ? 1 : 0;
    if (!too_far_out(a, b, allowance, size_x))
      continue;
    ++ruled_out;
    CHECK_FALSE(comes_near);
  }
  CHECK(near > 5000);
  CHECK(ruled_out > 3000);
}

} // namespace audit_test
