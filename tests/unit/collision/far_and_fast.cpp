// Cases in which bounds are hardest to keep: orbits so fast that two particles may touch through another image, long
// boxes, long steps, very few particles, and random cases. Against the plain twin, bit by bit.
#include "unit/collision/spheres.hpp"
#include "unit/collision/twin.hpp"

#include <keeler/collision/costs.hpp>
#include <keeler/core/threads.hpp>

namespace far_and_fast_test {

using namespace keeler;
using namespace keeler::collision;
using test::RandomVectors;
using test::Ring;
using test::Sphere;
using test::Twin;

namespace {

struct Threads {
  int before = threads();
  explicit Threads(int count) { set_threads(count); }
  ~Threads() { set_threads(before); }
};

CollisionSettings restitution(double value) {
  CollisionSettings settings;
  settings.restitution = constant_restitution(value);
  return settings;
}

// Adds so many contacts, high above all other particles, that several threads carry out the step's.
void add_small_pairs(std::vector<Sphere>& spheres, double step) {
  for (int k = 0; k < 50; ++k)
    for (const double side : {-1.0, 1.0})
      spheres.push_back(
          {{side * 0.0101, 1.5 * (k - 25), 50.0}, {side * -0.0004 / step, 0.0, 0.0}, 0.01, 1e-6}); // meet at h/4
}

// In a box of 100 by 120, elastic; the first step with a watch or, on two threads among small pairs, without.
void meets_as_the_twin_says(std::vector<Sphere> spheres, double step, std::size_t least) {
  for (const bool several : {false, true}) {
    CAPTURE(several);
    const Threads scope(several ? 2 : 1);
    if (several)
      add_small_pairs(spheres, step);
    Ring ring(test::patch_of(spheres, 100.0, 120.0), restitution(1.0), step);
    ring.steps = several ? 1 : 0;
    ring.keeps_neighbours = true;
    Twin twin(ring, restitution(1.0));
    const std::size_t collisions = twin.advance();
    CHECK(collisions >= least + (several ? 50 : 0));
    twin.advance(3);
  }
}

} // namespace

// Two light spheres at the ends of the box are shot at by heavy ones, outward or inward: each of the two alone keeps
// below what may meet another through a second image, both together do not.
TEST_CASE("two that were hit and are fast meet, wherever") {
  for (const double step : {1e-4, 1e-3, 1e-2})
    for (const double way : {10.0, 12.0, 13.0, 13.5, 20.0, 30.0})
      for (const double start : {26.5, -26.5}) {
        CAPTURE(step);
        CAPTURE(way);
        CAPTURE(start);
        const double speed = 2.0 * way / step, behind = start + (start > 0.0 ? 2.0 : -2.0) + way;
        const std::vector<Sphere> spheres{{{-behind, 0, 0}, {speed, 0, 0}, 1.0, 1e6},
                                          {{behind, 0, 0}, {-speed, 0, 0}, 1.0, 1e6},
                                          {{-start, 0, 0}},
                                          {{start, 0, 0}}};
        meets_as_the_twin_says(spheres, step, 1);
      }
}

TEST_CASE("one that was hit crosses more than half of the box, and meets one that was hit before") {
  for (const double step : {1e-4, 1e-3, 1e-2})
    for (const double way : {15.0, 20.0, 30.0, 45.0}) {
      CAPTURE(step);
      CAPTURE(way);
      const std::vector<Sphere> spheres{{{-17.0 - way, 0, 0}, {2.0 * way / step, 0, 0}, 1.0, 1e6},
                                        {{-15, 0, 0}},
                                        {{41, 0, 0}},
                                        {{41, 2.001, 0}, {0, -0.001 / (0.6 * step), 0}}};
      meets_as_the_twin_says(spheres, step, 2);
    }
}

// Two circles in one plane, which the shear brings together shortly before the seventeenth step after the first ends.
// Lines and times in single precision must not put that off to the step after it.
TEST_CASE("long steps in boxes of up to 10^6 radii: no contact comes a step late") {
  struct Box {
    double x, y;
  };
  const Threads scope(1);
  std::size_t kept = 0, hits = 0, cases = 0;
  for (const double orbits : {0.3, 0.05})
    for (const Box& box : {Box{100.0, 1e6}, Box{1e6, 100.0}, Box{1e6, 1e3}, Box{1e5, 1e4}, Box{1e6, 1e6}})
      for (const double depth : {1e-9, 1e-7, 1e-5, 1e-3}) { // how far before the end, m
        CAPTURE(orbits);
        CAPTURE(box.x);
        CAPTURE(box.y);
        CAPTURE(depth);
        const double step = two_pi * orbits;
        RandomVectors random(5);
        for (int k = 0; k < 60; ++k, ++cases) {
          CAPTURE(k);
          const double x = 0.9 * box.x * (random.uniform() - 0.5), dx = 1.2 + 0.7 * random.uniform();
          const double when = 16.5 * step - depth * random.uniform() / (1.5 * dx); // after the first epoch
          const double dy = std::sqrt(4.0 - dx * dx) + 1.5 * dx * when;
          Ring ring(test::patch_of({{{x, 0, 0}}, {{x + dx, 0, 0}}}, box.x, box.y), {}, step);
          ring.keeps_neighbours = true;
          for (const int i : {0, 1}) {
            Elements& el = ring.particles.bodies[i].elements;
            el = {x + i * dx, (i - 0.5) * dy};
            el = ring.box.image_of(el, ring.box.image_into_cell(el.guiding_x, el.guiding_y, ring.epoch_offset()),
                                   ring.epoch_offset());
          }
          Twin twin(ring, {});
          std::size_t hit = 0;
          while (hit == 0 && ring.steps < 19)
            hit = twin.advance();
          hits += hit > 0;
          kept += ring.drift.costs().lists_made < 12;
        }
      }
  CHECK(hits == cases);
  CHECK(kept == cases / 2); // steps of 0.05 orbit
}

TEST_CASE("no particle, one and two, for many steps, kicked or not") {
  for (const int count : {1, 2}) {
    const Threads scope(count);
    for (const double side : {2.5, 10.0, 1e6})
      for (const double step : {1e-4, 1e-3, 0.3})
        for (const double kick : {0.0, 1e-6, 0.3})
          for (int number = 0; number <= 2; ++number) {
            CAPTURE(side);
            CAPTURE(step);
            CAPTURE(kick);
            CAPTURE(number);
            std::vector<Sphere> spheres{{{-0.2 * side, 0.1, 1.5}, {1.0, 1.0, -1.0}}, {{0.2 * side, 0.1, -1.0}}};
            spheres.resize(static_cast<std::size_t>(number));
            Ring ring(test::patch_of(spheres, side, side), {}, two_pi * step);
            ring.keeps_neighbours = true;
            Twin twin(ring, {});
            for (int k = 0; k < 40; ++k) {
              twin.advance();
              if (kick > 0.0 && k % 3 == 0)
                ring.kick_all(kick);
            }
            CHECK(ring.drift.costs().steps == 40);
          }
  }
}

namespace {

// A random patch of 30 to 120 spheres that do not overlap; all quantities are drawn over decades.
struct Chance {
  RandomVectors random;
  Frequencies frequencies;
  double step, size_x, size_y, speed;
  CollisionSettings settings;
  std::vector<Sphere> spheres;

  explicit Chance(std::uint64_t seed) : random(seed) {
    frequencies = {0.6 + 0.9 * random.uniform(), 0.8 + 3.0 * random.uniform()};
    step = two_pi * decades(-4.0, -0.53); // to 0.3 orbit
    speed = decades(-3.0, 0.5);
    settings = restitution(random.uniform() < 0.3 ? 1.0 : 0.5);
    const std::vector<double> radii = draw_sizes();
    double area = 0.0;
    for (const double r : radii)
      area += pi * r * r;
    const bool long_step = step > 0.3; // in the midst of others it may wedge spheres in for 10⁵ contacts
    const double depth = long_step ? 0.02 + 0.2 * random.uniform() : 0.2 + 1.3 * random.uniform();
    const double aspect = decades(-0.6, 0.6), side = std::sqrt(area / depth), least = long_step ? 15.0 : 4.5;
    size_x = std::max(least, side * aspect);
    size_y = std::max(least, side / aspect);
    const double thickness = 3.0 * random.uniform();
    for (const double r : radii)
      place(r, thickness);
  }

  double decades(double least, double most) { return std::pow(10.0, least + (most - least) * random.uniform()); }

  // The largest first.
  std::vector<double> draw_sizes() {
    std::vector<double> radii(static_cast<std::size_t>(30.0 + 90.0 * random.uniform()));
    const double smallest = decades(-2.0, 0.0);
    for (double& r : radii)
      r = std::pow(smallest, random.uniform());
    std::sort(radii.rbegin(), radii.rend());
    return radii;
  }

  // Places a sphere where it overlaps no other and no edge, or not at all when such a place is hard to find. One in
  // twenty is fast.
  void place(double r, double thickness) {
    for (int tries = 0; tries < 300; ++tries) {
      const Vec3 at((size_x - 2.0 * r) * (random.uniform() - 0.5), (size_y - 2.0 * r) * (random.uniform() - 0.5),
                    thickness * (random.uniform() - 0.5));
      if (std::any_of(spheres.begin(), spheres.end(),
                      [&](const Sphere& s) { return (s.position - at).norm() < 1.0001 * (s.radius + r); }))
        continue;
      const double fast = speed * (random.uniform() < 0.05 ? 20.0 : 1.0);
      spheres.push_back({at, fast * random.uniform() * random.direction(), r, r * r * r * decades(0.0, 3.0)});
      return;
    }
  }
};

} // namespace

TEST_CASE("the same bits as the plain twin: everything drawn at random") {
  std::size_t collisions = 0, images = 0;
  for (std::uint64_t seed = 1; seed <= 180; ++seed) {
    CAPTURE(seed);
    Chance chance(seed);
    const Threads scope(chance.random.uniform() < 0.5 ? 1 : 2);
    Patch patch = test::patch_of(chance.spheres, chance.size_x, chance.size_y, chance.frequencies);
    patch.box.first_offset = chance.size_y * chance.random.uniform();
    Ring ring(patch, chance.settings, chance.step);
    ring.keeps_neighbours = true;
    Twin twin(ring, chance.settings);
    const double kick = chance.random.uniform() < 0.5 ? 0.0 : chance.speed * chance.decades(-4.0, 0.0);
    for (std::size_t last = 0; ring.steps < 16 && last < 150;) {
      last = twin.advance();
      collisions += last;
      for (const CollisionRecord& record : twin.last)
        images += !(record.image == Image{});
      if (kick > 0.0 && ring.steps % 2 == 0)
        ring.kick_all(kick * (ring.steps % 9 == 1 ? 30.0 : 1.0));
    }
  }
  CHECK(collisions > 20000);
  CHECK(images > 8000);
}

} // namespace far_and_fast_test
