#include <keeler/collision/drift.hpp>

#include "draws.hpp"
#include "unit/collision/brute_force.hpp"
#include "unit/collision/scenario.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

namespace drift_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

using test::omega;
using test::Scenario;
using test::settings_of;

struct Start {
  Particles particles;
  ShearingBox box;
  double offset; // shear offset at the epoch, the middle of the step
};

Start make_start(const Scenario& s, std::uint64_t seed) {
  const Patch patch = test::make_patch(s, seed);
  return {particles_from(patch, 0.5 * s.step), patch.box, patch.box.offset(1, 0.5 * s.step)};
}

std::vector<CollisionRecord> run_drift(const Scenario& s, Start& start, CollisionTally& tally) {
  DriftPhase drift(settings_of(s), {s.kappa, s.nu}, omega, s.step);
  struct Recorder : DriftObserver {
    std::vector<CollisionRecord> records;
    void collided(const CollisionRecord& record) override { records.push_back(record); }
  } recorder;
  drift.observe(&recorder);
  drift.collide(start.particles, start.box, start.offset, tally);
  return recorder.records;
}

// Compares one drift with the twin; returns the number of collisions. Times must agree to 1e-9 of a step, or to the
// rounding of |d|² − R² (about 1e-14 (R² + R times a coordinate of 30)) over its slope where grazing makes that larger.
std::size_t compare(const Scenario& s, std::uint64_t seed, int scans) {
  Start start = make_start(s, seed), copy = start;
  CollisionTally tally;
  const std::vector<CollisionRecord> records = run_drift(s, start, tally);
  test::BruteForce twin(settings_of(s), {s.kappa, s.nu}, omega, s.step, scans);
  const std::vector<CollisionRecord> expected = twin.collide(copy.particles, copy.box, copy.offset);
  REQUIRE(records.size() == expected.size());
  for (std::size_t k = 0; k < records.size(); ++k) {
    CHECK(records[k].low_id == expected[k].low_id);
    CHECK(records[k].high_id == expected[k].high_id);
    CHECK(records[k].image == expected[k].image);
    const double rounding = 3e-13 / std::max(1e-9, expected[k].normal_speed);
    CHECK(std::fabs(records[k].time - expected[k].time) <= std::max(1e-9 * s.step, rounding));
  }
  return records.size();
}

} // namespace

TEST_CASE("the same collisions as the brute-force twin: pairs, images, order, times") {
  std::size_t collisions = 0;
  Scenario s;
  SUBCASE("a thousandth of an orbit") {
    s.step = two_pi * 1e-3;
  }
  SUBCASE("a hundredth of an orbit") {
    s.step = two_pi * 1e-2;
  }
  SUBCASE("general frequencies") {
    s.kappa = 0.95, s.nu = 3.6;
    s.step = two_pi * 5e-3;
  }
  SUBCASE("sizes 1:10") {
    s.smallest = 0.1;
    s.count = 90;
    s.step = two_pi * 5e-3;
  }
  SUBCASE("filling 0.4, small sizes too") {
    s.filling = 0.4, s.smallest = 0.3, s.optical_depth = 1.2;
    s.step = two_pi * 3e-3;
  }
  SUBCASE("filling 0.4, equal sizes, large step") {
    s.filling = 0.4, s.optical_depth = 1.0, s.count = 40;
    s.step = two_pi * 2e-2;
  }
  SUBCASE("the bridges law") {
    s.restitution = bridges_restitution(0.34);
    s.step = two_pi * 1e-2;
  }
  for (std::uint64_t seed = 1; seed <= test::draws(12); ++seed)
    collisions += compare(s, seed, 400);
  CHECK(collisions > test::draws(10)); // the comparison is not empty
}

TEST_CASE("two hundred particles against the twin") {
  Scenario s;
  s.count = 200;
  s.step = two_pi * 5e-3;
  for (const double filling : {0.1, 0.4}) {
    s.filling = filling;
    s.optical_depth = filling > 0.2 ? 1.0 : 0.5;
    CHECK(compare(s, 21, 300) > 5);
  }
}

TEST_CASE("the same bits for any number of threads and any order in memory") {
  Scenario s;
  s.count = 3000;
  s.step = two_pi * 1e-2;
  const Start start = make_start(s, 5);
  set_threads(1);
  Start one = start;
  CollisionTally tally_one;
  const auto records = run_drift(s, one, tally_one);
  CHECK(records.size() > 100);

  for (const int count : {2, 3}) {
    set_threads(count);
    Start other = start;
    CollisionTally tally;
    run_drift(s, other, tally);
    CHECK(std::memcmp(one.particles.bodies.data(), other.particles.bodies.data(), 64 * s.count) == 0);
    CHECK(tally.energy_lost == tally_one.energy_lost);
  }
  Start reversed = start;
  std::reverse(reversed.particles.bodies.begin(), reversed.particles.bodies.end());
  std::reverse(reversed.particles.ids.begin(), reversed.particles.ids.end());
  CollisionTally tally;
  run_drift(s, reversed, tally);
  std::reverse(reversed.particles.bodies.begin(), reversed.particles.bodies.end());
  CHECK(std::memcmp(one.particles.bodies.data(), reversed.particles.bodies.data(), 64 * s.count) == 0);
  CHECK(tally.momentum_flux == tally_one.momentum_flux);
}

TEST_CASE("handing every candidate to the finder, or watching, changes no bit") {
  Scenario s;
  s.count = 1000;
  s.step = two_pi * 1e-2;
  const Start start = make_start(s, 6);
  Start plain = start, all = start;
  CollisionTally tally_plain, tally_all;
  DriftPhase drift(settings_of(s), {s.kappa, s.nu}, omega, s.step);
  drift.collide(plain.particles, plain.box, plain.offset, tally_plain);
  CHECK(tally_plain.fast > 30);
  struct Everything final : DriftObserver {
    bool wants_every_candidate() const override { return true; }
  } everything;
  drift.observe(&everything);
  drift.collide(all.particles, all.box, all.offset, tally_all);
  CHECK(std::memcmp(plain.particles.bodies.data(), all.particles.bodies.data(), 64 * s.count) == 0);
  CHECK(tally_all.momentum_flux == tally_plain.momentum_flux);
}

TEST_CASE("collisions keep the sums that mechanics keeps, and lose the energy that they book") {
  for (const double nu : {1.0, 3.6}) {
    Scenario s;
    s.count = 800;
    s.nu = nu;
    s.smallest = 0.3;
    s.step = two_pi * 1e-2;
    s.kappa = 0.99458;
    Start start = make_start(s, 8);
    const Frequencies f{s.kappa, s.nu};
    const auto sums = [&](const Particles& p) {
      Eigen::Array<double, 7, 1> total = Eigen::Array<double, 7, 1>::Zero();
      for (const Body& b : p.bodies) {
        const Elements& el = b.elements;
        total += b.mass * Eigen::Array<double, 7, 1>{el.guiding_x, el.guiding_y,           el.e_cos, el.e_sin, el.i_sin,
                                                     el.i_cos,     epicyclic_energy(el, f)};
      }
      return total;
    };
    const auto before = sums(start.particles);
    CollisionTally tally;
    const auto records = run_drift(s, start, tally);
    CHECK(records.size() > 20);
    const auto after = sums(start.particles);
    double scale = 0.0; // size of the terms of the sums
    for (const Body& b : start.particles.bodies)
      scale += b.mass * (std::fabs(b.elements.guiding_x) + std::fabs(b.elements.guiding_y));
    for (int k = 0; k < 6; ++k)
      CHECK(std::fabs(after[k] - before[k]) < 1e-14 * scale);
    CHECK(tally.energy_lost > 0.0);
    CHECK(std::fabs(after[6] - before[6] - epicyclic_gain(tally, f)) < 1e-12 * before[6]);
  }
}

TEST_CASE("no overlap deeper than rounding after many dense steps") {
  Scenario s;
  s.count = 300;
  s.filling = 0.4;
  s.optical_depth = 1.0;
  s.step = two_pi * 2e-3;
  Start start = make_start(s, 2);
  DriftPhase drift(settings_of(s), {1.0, 1.0}, omega, s.step);
  const hill::Rebase rebase({1.0, 1.0}, s.step);
  CollisionTally tally;
  for (int step = 0; step < 200; ++step) {
    const double offset = start.box.offset(2 * step + 1, 0.5 * s.step);
    drift.collide(start.particles, start.box, offset, tally);
    const double end_offset = start.box.offset(2 * step + 2, 0.5 * s.step);
    const Patch patch = make_patch(start.particles, start.box, end_offset, {1.0, 1.0}, 0.5 * s.step);
    CHECK(cells::largest_overlap(patch).depth < 1e-11);
    for (Body& body : start.particles.bodies)
      rebase(body.elements);
  }
  CHECK(tally.fast > 1000);
}

TEST_CASE("bad elements and unknown finders are errors, not hangs") {
  Scenario s;
  Start start = make_start(s, 1);
  start.particles.bodies[3].elements.e_cos = std::nan("");
  CollisionTally tally;
  CHECK_THROWS_AS(run_drift(s, start, tally), InvariantError);
  CollisionSettings settings;
  settings.finder = "guess";
  CHECK_THROWS_AS(DriftPhase(settings, {1, 1}, omega, 0.01), UsageError);
}

TEST_CASE("stacked spheres that hardly hop, and sticking ones, do not collide without end") {
  // Vertical gravity presses the upper sphere onto the lower one; a rebound far below v_cut stays within rounding.
  for (const double receding : {1e-7, 1e-8, 1e-13, 0.0})
    for (const double restitution : {0.5, 0.0}) {
      Scenario s;
      s.restitution = constant_restitution(restitution);
      Start start{{}, {100.0, 100.0, 1.5, 0.0}, 0.0};
      const Frequencies f{1.0, 1.0};
      for (int k = 0; k < 3; ++k) {
        const State state{{40.0, 0.0, 2.0 * k}, {0.0, -60.0, receding * k}};
        start.particles.bodies.push_back({elements_from(state, f, Rotation(f, -0.5 * s.step)), 1.0, 1.0});
        start.particles.ids.push_back(k);
      }
      CollisionTally tally;
      CHECK(run_drift(s, start, tally).size() < 5000);
    }
}

TEST_CASE("a state of perfectly inelastic spheres runs") {
  Scenario s;
  s.count = 300;
  s.step = two_pi * 5e-3;
  s.restitution = constant_restitution(0.0);
  Start start = make_start(s, 4);
  DriftPhase drift(settings_of(s), {1.0, 1.0}, omega, s.step);
  const hill::Rebase rebase({1.0, 1.0}, s.step);
  CollisionTally tally;
  const int steps = static_cast<int>(test::draws(100));
  for (int step = 0; step < steps; ++step) {
    drift.collide(start.particles, start.box, start.box.offset(2 * step + 1, 0.5 * s.step), tally);
    for (Body& body : start.particles.bodies)
      rebase(body.elements);
  }
  CHECK(tally.fast > test::draws(100));
}

} // namespace drift_test
