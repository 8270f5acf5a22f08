// The drift phase over many steps, with everything that it keeps from one to the next, against the plain algorithm, bit
// by bit.
#include "draws.hpp"
#include "unit/collision/spheres.hpp"
#include "unit/collision/twin.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

namespace many_steps_test {

using namespace keeler;
using namespace keeler::collision;
using test::Ring;
using test::Scenario;
using test::Twin;

namespace {

// Returns the number of collisions of a scenario's patch in some steps, with lists kept from step to step.
std::size_t walk(const Scenario& s, std::uint64_t seed, int steps) {
  Ring ring(test::make_patch(s, seed), test::settings_of(s), s.step);
  ring.keeps_neighbours = true;
  return Twin(ring, test::settings_of(s)).advance(steps);
}

Ring ring_of(const std::vector<test::Sphere>& spheres, double side, double step, const Frequencies& f = {}) {
  return Ring(test::patch_of(spheres, side, 0.9 * side, f), {}, step);
}

std::size_t walk(Ring& ring, int steps) {
  ring.keeps_neighbours = true;
  return Twin(ring, {}).advance(steps);
}

} // namespace

TEST_CASE("the same bits as the plain twin: equilibrium and dense, for steps from 1/10000 to 1/20 orbit") {
  struct Case {
    double step; // orbits
    int steps;
  };
  for (const Case& c : {Case{1e-4, 80}, Case{1e-3, 80}, Case{5e-3, 60}, Case{2e-2, 40}, Case{5e-2, 40}})
    for (const std::uint64_t seed : {1u, 2u}) {
      CAPTURE(c.step);
      Scenario s;
      s.count = 100;
      s.step = two_pi * c.step;
      CHECK(walk(s, seed, c.steps) > 2000 * c.step * c.steps / 10);
      s.count = 70;
      s.filling = 0.4, s.optical_depth = 1.2;
      CHECK(walk(s, seed, c.steps) > 2000 * c.step * c.steps / 10);
    }
}

TEST_CASE("the same bits as the plain twin: general frequencies, sizes 1:30, sticky and elastic spheres") {
  Scenario s;
  s.count = 80;
  s.step = two_pi * 4e-3;
  SUBCASE("an oblate planet") {
    s.kappa = 0.986, s.nu = 1.013;
  }
  SUBCASE("a thin disk's vertical frequency") {
    s.nu = 3.6, s.kappa = 0.9;
  }
  SUBCASE("sizes 1:30") {
    s.smallest = 1.0 / 30, s.count = 150;
  }
  SUBCASE("sizes 1:30 and nu = 3.6, dense") {
    s.smallest = 1.0 / 30, s.count = 120, s.filling = 0.35, s.nu = 3.6;
  }
  SUBCASE("no rebound") {
    s.restitution = constant_restitution(0.0), s.filling = 0.3;
  }
  SUBCASE("elastic") {
    s.restitution = constant_restitution(1.0);
  }
  SUBCASE("the bridges law") {
    s.restitution = bridges_restitution(0.34);
  }
  SUBCASE("rough spheres") {
    s.friction = {.tangential_restitution = 0.5};
  }
  SUBCASE("rough spheres that reverse their slip, sizes 1:5, some slide") {
    s.friction = {.tangential_restitution = -0.8, .coefficient = 0.6}, s.smallest = 0.2, s.filling = 0.3;
  }
  std::size_t collisions = 0;
  for (std::uint64_t seed = 3; seed < 3 + test::draws(3); ++seed)
    collisions += walk(s, seed, 60);
  CHECK(collisions > 50);
}

TEST_CASE("the same bits as the plain twin: a moonlet among spheres a thousandth of its size") {
  for (const double step : {1e-4, 1e-3, 1e-2})
    for (const double side : {3.0, 50.0}) { // images of the moonlet are near; cells can be small
      CAPTURE(step);
      CAPTURE(side);
      Ring ring = ring_of(test::swarm(240, 1e-3, 0.02, 0.05, 7), side, two_pi * step);
      CHECK(walk(ring, 50) > 30);
    }
}

TEST_CASE("the same bits as the plain twin: one particle outruns the others' bounds") {
  Scenario s;
  s.count = 100;
  s.step = two_pi * 1e-3;
  for (const double times : {30.0, 300.0})
    for (const double mass : {1.0, 1e4}) { // the heavy one speeds up each particle that it hits, in mid-interval
      CAPTURE(times);
      CAPTURE(mass);
      Patch patch = test::make_patch(s, 9);
      patch.velocities[17] += times * Vec3(1.3, -0.7, 0.2);
      patch.masses[17] *= mass;
      Ring ring(patch, {}, s.step);
      CHECK(walk(ring, 60) > 30);
    }
  // quiet lists for some steps, then a fast particle arrives
  std::vector<test::Sphere> spheres;
  for (int k = 0; k < 60; ++k)
    spheres.push_back({{4.0 * (k % 8 - 4), 4.0 * (test::quotient(k, 8) - 4), 0.0}, Vec3::Zero(), 1.0, 1.0});
  for (const double speed : {200.0, 2000.0, 30000.0}) {
    CAPTURE(speed);
    std::vector<test::Sphere> shot = spheres;
    shot.push_back({{-45.0, -20.0, 0.3}, speed * Vec3(1.0, 0.3, 0.0), 1.0, 1e3});
    Ring ring = ring_of(shot, 120.0, two_pi * 1e-3);
    CHECK(walk(ring, 60) > 3);
  }
}

// Without eccentricity at first all bounds are small; heavy particles throw light ones at each other.
TEST_CASE("the same bits as the plain twin: cold states that heat up within a step") {
  std::size_t collisions = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(20); ++seed)
    for (const double step : {1e-3, 1e-2, 4e-2}) {
      CAPTURE(seed);
      CAPTURE(step);
      std::vector<test::Sphere> spheres = test::swarm(90, 0.05, 0.8, 0.0, seed);
      for (std::size_t k = 1; k < spheres.size(); k += 3)
        spheres[k].mass = std::pow(10.0, static_cast<double>(k % 5)) * spheres[0].mass;
      Ring ring = ring_of(spheres, 8.0, two_pi * step);
      for (Body& b : ring.particles.bodies)
        b.elements.e_cos = b.elements.e_sin = b.elements.i_cos = 0.0;
      collisions += walk(ring, 8);
    }
  CHECK(collisions > test::draws(5000));
}

TEST_CASE("the same bits as the plain twin: one strong kick in the middle of a quiet interval") {
  for (const double kick : {0.5, 5.0, 50.0, 500.0})
    for (const double step : {1e-4, 3e-4, 1e-3})
      for (const int at : {1, 4, 7, 10}) {
        CAPTURE(kick);
        CAPTURE(step);
        CAPTURE(at);
        Scenario s;
        s.count = 100;
        s.filling = 0.3;
        s.step = two_pi * step;
        Ring ring(test::make_patch(s, 12), {}, s.step);
        ring.keeps_neighbours = true;
        Twin twin(ring, {});
        for (int k = 1; k <= 22; ++k) {
          twin.advance();
          if (k % 11 == at)
            ring.kick_all(kick);
        }
      }
}

TEST_CASE("the same bits as the plain twin: kicks between the steps") {
  struct Case {
    double size; // rΩ
    int every;
    double rare; // instead, in every 17th step
  };
  for (const Case& c :
       {Case{1e-3, 1, 1e-3}, Case{0.1, 1, 0.1}, Case{0.3, 3, 0.3}, Case{1e-6, 1, 3.0}, Case{1e-9, 1, 200.0}})
    for (const bool dense : {false, true})
      for (const double step : {1e-3, 1e-2}) {
        CAPTURE(c.size);
        CAPTURE(c.every);
        CAPTURE(dense);
        CAPTURE(step);
        Scenario s;
        s.count = 80;
        s.smallest = 0.3;
        s.step = two_pi * step;
        s.filling = dense ? 0.4 : 0.15;
        Ring ring(test::make_patch(s, 11), {}, s.step);
        ring.keeps_neighbours = true;
        Twin twin(ring, {});
        std::size_t collisions = 0;
        for (int k = 1; k <= 50; ++k) {
          collisions += twin.advance();
          if (k % 17 == 0)
            ring.kick_all(c.rare);
          else if (k % c.every == 0)
            ring.kick_all(c.size);
        }
        CHECK(collisions > 10);
      }
}

TEST_CASE("the same bits as the plain twin: boxes of a few radii, where two particles meet in several images") {
  std::size_t collisions = 0, images = 0, both = 0; // through an image; through two images of one pair in one step
  for (const double side : {2.2, 2.6, 3.2, 4.0, 5.0, 7.0})
    for (const double step : {1e-4, 1e-3, 1e-2, 5e-2})
      for (const double speed : {1.0, 20.0}) {
        test::RandomVectors random(static_cast<std::uint64_t>(10 * side));
        std::vector<test::Sphere> spheres; // one above the other, layers of three diameters
        for (int k = 0; k < 4; ++k)
          spheres.push_back({{0.4 * side * (random.uniform() - 0.5), side * (random.uniform() - 0.5), 2.1 * (k - 1.5)},
                             speed * random.direction()});
        Ring ring = ring_of(spheres, side, two_pi * step);
        ring.keeps_neighbours = true;
        Twin twin(ring, {});
        for (int k = 0; k < 60; ++k) {
          collisions += twin.advance();
          for (std::size_t a = 0; a < twin.last.size(); ++a) {
            images += !(twin.last[a].image == Image{});
            for (std::size_t b = 0; b < a; ++b)
              both += twin.last[a].low_id == twin.last[b].low_id && twin.last[a].high_id == twin.last[b].high_id &&
                      !(twin.last[a].image == twin.last[b].image);
          }
        }
      }
  CHECK(collisions > 300);
  CHECK(images > 100);
  CHECK(both > 20);
}

TEST_CASE("the same bits as the plain twin: a thousand particles on 1, 2, 3 and 8 threads") {
  const int before = threads();
  for (const int count : {1, 2, 3, 8}) {
    set_threads(count);
    Scenario s;
    s.count = 1000;
    s.filling = 0.4, s.optical_depth = 1.0;
    s.step = two_pi * 2e-2; // long chains of contacts
    CHECK(walk(s, 13, 3) > 500);
    s.step = two_pi * 2e-3;
    s.smallest = 0.1;
    CHECK(walk(s, 13, 8) > 20);
  }
  set_threads(before);
}

// Simulation with gravity: the kicks are repeated here from the accelerations that it publishes.
TEST_CASE("the same bits as the plain twin: a run with self-gravity, kicks every step and every third step") {
  for (const int every : {1, 3}) {
    CAPTURE(every);
    const Scene scene = parse_scene(fmt::format(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [24.0, 20.0]
[particles]
count = 90
density = 900.0
sizes = {{ law = "power", exponent = 3.0, min = 0.3, max = 1.0 }}
[gravity]
solver = "direct"
resting_contacts = "bounced"
kick_every = {}
[time]
step = 2e-3
end = 1.0
)",
                                                every),
                                    "test scene");
    Scenario s;
    s.count = 90;
    s.smallest = 0.3;
    Patch patch = test::make_patch(s, 15);
    for (double& mass : patch.masses)
      mass *= 2.0;
    Simulation simulation(scene, patch);
    const Frequencies f = scene.planet.frequencies;
    const double step = simulation.state().step_length;
    const Rotation boundary(f, -0.5 * step);
    test::PlainDrift plain(scene.collisions, f, scene.planet.orbital_frequency, step);
    test::Recorder recorder;
    simulation.drift().observe(&recorder);
    std::size_t collisions = 0;
    for (int k = 0; k < 90; ++k) {
      const simulation::SimulationState& state = simulation.state();
      Particles copy = state.particles;
      const auto half_kick = [&] {
        for (std::size_t i = 0; i < copy.size(); ++i)
          kick(copy.bodies[i].elements, 0.5 * step * every * state.forces[0].accelerations[i], f, boundary);
      };
      if (k % every == 0)
        half_kick();
      CollisionTally tally;
      const double middle = 0.5 * step * (every - 1 - 2 * (k % every)); // of the kick interval
      const std::vector<Vec3> accelerations = state.forces[0].accelerations;
      const auto expected = plain.collide(copy, state.box, state.epoch_offset(), tally,
                                          {.accelerations = accelerations, .middle = middle});
      recorder.records.clear();
      simulation.advance();
      INFO("step ", k);
      CHECK(recorder.records.size() == expected.size());
      REQUIRE(test::same_records(recorder.records, expected) == expected.size());
      test::in_order_of(copy, state.particles);
      const hill::Rebase rebase(f, step);
      for (Body& body : copy.bodies) {
        Elements& el = body.elements;
        rebase(el);
        const double offset = state.epoch_offset();
        el = state.box.image_of(el, state.box.image_into_cell(el.guiding_x, el.guiding_y, offset), offset);
      }
      if ((k + 1) % every == 0)
        half_kick();
      REQUIRE(test::same_bits(state.particles, copy));
      collisions += expected.size();
    }
    CHECK(collisions > 100);
  }
}

} // namespace many_steps_test
