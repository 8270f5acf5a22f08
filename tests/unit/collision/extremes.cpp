// The drift phase with extreme numbers: against its plain twin where the state is small, and against the laws of
// mechanics.
#include "unit/collision/spheres.hpp"
#include "unit/collision/twin.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>

namespace extremes_test {

using namespace keeler;
using namespace keeler::collision;
using test::Ring;
using test::Scenario;
using test::Sphere;
using test::Twin;

namespace {

CollisionSettings restitution(double value) {
  CollisionSettings settings;
  settings.restitution = constant_restitution(value);
  return settings;
}

// Counts the collisions of some steps. They must equal the twin's to the bit, and no sphere may overlap another: a gap
// is exact to 1e-14 of coordinates of up to `size` radii.
std::size_t walk(Ring& ring, int steps, const CollisionSettings& settings = {}) {
  ring.keeps_neighbours = true;
  const std::size_t collisions = Twin(ring, settings).advance(steps);
  CHECK(cells::largest_overlap(ring.patch()).depth < 1e-13 * (ring.box.size_x + ring.box.size_y + 10.0));
  return collisions;
}

std::size_t walk(const std::vector<Sphere>& spheres, double side, double step, int steps,
                 const CollisionSettings& settings = {}) {
  Ring ring(test::patch_of(spheres, side, side), settings, step);
  return walk(ring, steps, settings);
}

} // namespace

TEST_CASE("circles in one plane stay in it, and meet by the shear alone") {
  std::vector<Sphere> spheres;
  for (int k = 0; k < 60; ++k) // e = i = 0: the velocity is the shear's to the bit
    spheres.push_back({{0.8 * (k - 30), 3.0 * (k * 7 % 13) - 18.0, 0.0}});
  Ring ring(test::patch_of(spheres, 50.0, 39.0), {}, two_pi * 1e-2);
  for (Body& b : ring.particles.bodies)
    b.elements.e_cos = b.elements.e_sin = b.elements.i_sin = b.elements.i_cos = 0.0;
  CHECK(walk(ring, 30) > 100);
  for (const Body& b : ring.particles.bodies) {
    CHECK(b.elements.i_sin == 0.0);
    CHECK(b.elements.i_cos == 0.0);
  }
}

TEST_CASE("what is at rest stays at rest: one orbit shared by all, touching or not") {
  for (const double distance : {2.0, 2.0 + 1e-15, 2.5}) {
    std::vector<Sphere> spheres;
    for (int k = 0; k < 40; ++k)
      spheres.push_back({{0.0, distance * (k - 19.5), 0.0}});
    Ring ring(test::patch_of(spheres, 100.0, 100.0), {}, two_pi * 1e-2);
    const Particles before = ring.particles;
    CHECK(walk(ring, 50) == 0);
    CHECK(test::same_bits(ring.particles, before));
  }
  // at rest in the turning frame each falls along an epicycle of its own
  std::vector<Sphere> spheres;
  for (int k = 0; k < 64; ++k) {
    const Vec3 place(2.3 * (k % 4) - 4.0, 2.3 * (test::quotient(k, 4) % 4) - 4.0, 2.3 * (test::quotient(k, 16)) - 4.0);
    spheres.push_back({place, {0.0, 1.5 * place.x(), 0.0}});
  }
  CHECK(walk(spheres, 60.0, two_pi * 5e-3, 60) > 100);
}

TEST_CASE("a lattice at filling 0.6: no storm, and nothing sinks in") {
  const double side = std::cbrt(4.0 * (4.0 / 3.0 * pi) / 0.6); // of a cell of four spheres of radius 1
  test::RandomVectors random(1);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 3 * 3 * 2 * 4; ++k) {
    const Vec3 corner(test::quotient(k, 4) % 3 - 1.5, test::quotient(k, 12) % 3 - 1.5, test::quotient(k, 36) - 1.0);
    const Vec3 faces[] = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
    spheres.push_back({side * (corner + faces[k % 4]), 3.0 * random.direction()});
  }
  for (const double step : {1e-4, 1e-3, 1e-2}) {
    Ring lattice(test::patch_of(spheres, 3.0 * side, 3.0 * side), {}, two_pi * step);
    const std::size_t collisions = walk(lattice, 60);
    CHECK(collisions > 2e4 * (step - 5e-4));
    CHECK(collisions < 60 * 72 * 100); // a hundred per sphere and step, where a few are expected
  }
}

TEST_CASE("jammed rows, hit from above: no storm, and nothing sinks in") {
  // Three rows that nest in each other. Open rows touch; rows closed through the box's edge have 1e-6 of a radius to
  // each contact, for a contact below v_cut keeps its energy and a closed row without any room rings for ever.
  for (const bool closed : {false, true}) {
    CAPTURE(closed);
    const double spacing = closed ? 2.0 + 1e-6 : 2.0;
    std::vector<Sphere> spheres;
    for (int k = 0; k < 60; ++k) // e = 0 and X apart by √3: the shear moves whole rows
      spheres.push_back({{1.7320508075688774 * spacing / 2.0 * (test::quotient(k, 20)) - 1.8,
                          spacing * (k % 20 - 10 + 0.5 * (test::quotient(k, 20))), 0.0}});
    for (int k = 0; k < 10; ++k)
      spheres.push_back({{0.1, 4.0 * k - 19.3, 3.0}, {0.1, 0.0, -10.0}});
    Ring ring(test::patch_of(spheres, 12.0, closed ? 20 * spacing : 60.0), {}, two_pi * 2e-3);
    const std::size_t collisions = walk(ring, 60);
    CHECK(collisions > 100);
    CHECK(collisions < 60 * 70 * 100);
  }
}

TEST_CASE("optical depths from 1e-4 to 5, steps from 1e-6 to 0.3 orbit") {
  Scenario s;
  s.filling = 0.3;
  for (const double depth : {1e-4, 1e-2, 2.0, 5.0}) {
    CAPTURE(depth);
    s.optical_depth = depth;
    s.step = two_pi * 5e-3;
    Ring ring(test::make_patch(s, 1), {}, s.step);
    CHECK(walk(ring, 60) > 100.0 * (depth - 1.0));
  }
  for (const double step : {1e-6, 1e-5, 0.1, 0.3}) {
    CAPTURE(step);
    s.optical_depth = 0.3;
    s.step = two_pi * step;
    s.filling = 0.05;
    Ring ring(test::make_patch(s, 2), {}, s.step);
    CHECK(walk(ring, step < 0.1 ? 100 : 12) > 150.0 * (step - 0.01));
  }
}

TEST_CASE("sizes 1:10000 and masses 1:10^9") {
  for (const double side : {3.0, 40.0})
    for (const double step : {1e-5, 1e-3}) {
      CAPTURE(side);
      CAPTURE(step);
      Ring ring(test::patch_of(test::swarm(100, 1e-4, 1e-3, 0.05, 5), side, side), {}, two_pi * step);
      CHECK(walk(ring, 60) > 20);
    }
  Scenario s;
  s.count = 80;
  s.step = two_pi * 5e-3;
  Patch patch = test::make_patch(s, 3);
  test::RandomVectors random(3);
  for (double& mass : patch.masses)
    mass = std::pow(10.0, 9.0 * random.uniform());
  Ring ring(patch, {}, s.step);
  CHECK(walk(ring, 60) > 30);
}

TEST_CASE("elastic spheres keep their energy to rounding in each of 10^4 collisions of every particle") {
  // A column: they bounce along one vertical line, where nothing but their own weight acts.
  // Then a gas without shear (kappa = 2), in three dimensions and across the edges.
  const CollisionSettings elastic = restitution(1.0);
  constexpr int count = 10;
  test::RandomVectors random(7);
  std::vector<Sphere> column, gas;
  for (int k = 0; k < count; ++k) {
    column.push_back({{0.0, 0.0, 2.1 * (k - 4.5)}, {0.0, 0.0, 40.0 * (random.uniform() - 0.5)}});
    gas.push_back({{2.4 * (k % 2), 2.4 * (test::quotient(k, 2) % 2), 2.4 * (test::quotient(k, 4)) - 2.5},
                   3.0 * random.direction()});
  }
  Ring rings[] = {Ring(test::patch_of(column, 50.0, 50.0), elastic, two_pi * 0.05),
                  Ring(test::patch_of(gas, 5.5, 5.5, {2.0, 1.0}), elastic, two_pi * 0.02)};
  for (Ring& ring : rings) {
    ring.keeps_neighbours = true;
    const double start = test::total_energy(ring), scale = start; // no shear: nothing else than its own roundings
    double before = start;
    std::uint64_t collisions = 0;
    while (ring.tally.fast + ring.tally.slow < count * 10'000 / 2) {
      REQUIRE(ring.steps < 200'000);
      ring.advance();
      const std::uint64_t now = ring.tally.fast + ring.tally.slow;
      const double energy = test::total_energy(ring);
      // the sum over ten, and the roundings of each collision and of moving on: a few 1e-16 each
      REQUIRE(std::fabs(energy - before) <= 1e-15 * scale * (5.0 + static_cast<double>(now - collisions)));
      before = energy;
      collisions = now;
    }
    CHECK(ring.tally.energy_lost == 0.0);
    // 10^5 roundings of at most 5e-16 walk to some 2e-13, and would drift to 5e-11
    CHECK(std::fabs(before - start) < 2e-12 * scale);
  }
}

TEST_CASE("without restitution a pair leaves with a thousandth of the cut speed, and loses what it should") {
  const CollisionSettings settings = restitution(0.0);
  for (const double speed : {1e-3, 1.0, 1e3}) { // below v_cut = 0.01, and above
    const double step = two_pi * 1e-5;
    Ring ring(test::patch_of({{{-1.0 - 0.2 * speed * step, 0.0, 0.0}, {speed, 0.0, 0.0}}, {{1.0, 0.0, 0.0}}}, 50, 50),
              settings, step);
    Twin twin(ring, settings);
    CHECK(twin.advance() == 1);
    const Elements el = ring.particles.bodies[1].elements - ring.particles.bodies[0].elements; // of the next epoch
    const State state = state_at(el, {}, Rotation({}, twin.last[0].time - step));
    CHECK(state.velocity.dot(state.position.normalized()) ==
          doctest::Approx(speed < 0.01 ? twin.last[0].normal_speed : 1e-5).epsilon(1e-6));
  }
}

TEST_CASE("a box of 10^5 radii, with all particles about its corner") {
  const double side = 1e5;
  for (const double step : {1e-4, 1e-2}) {
    test::RandomVectors random(4);
    std::vector<Sphere> spheres;
    for (int k = 0; k < 80; ++k) {
      const Vec3 place(3.0 * (k % 4) - 4.5, 3.0 * (test::quotient(k, 4) % 4) - 4.5,
                       3.0 * (test::quotient(k, 16)) - 6.0);
      const Vec3 corner(place.x() < 0.0 ? 0.5 * side : -0.5 * side, place.y() < 0.0 ? 0.5 * side : -0.5 * side, 0.0);
      spheres.push_back({place + corner, 3.0 * random.direction()});
    }
    Ring ring(test::patch_of(spheres, side, side), {}, two_pi * step);
    CHECK(walk(ring, 60) > 5000.0 * (step - 1e-3));
  }
}

TEST_CASE("no particle, one, and two") {
  for (const double step : {1e-3, 0.3}) {
    CHECK(walk(std::vector<Sphere>{}, 10.0, two_pi * step, 30) == 0);
    CHECK(walk({{{4.0, 1.0, 0.3}, {2.0, 1.0, 1.0}}}, 10.0, two_pi * step, 30) == 0);
    CHECK(walk({{{4.0, 1.0, 0.3}, {3.0, 1.0, 1.0}}, {{-4.0, 1.0, 0.3}}}, 10.0, two_pi * step, 30) > 0);
  }
}

TEST_CASE("grazing pairs: a contact when the paths come nearer than two radii, none when they do not") {
  const double step = two_pi * 1e-4;
  for (const double depth : {1e-3, 1e-6, 1e-9, 1e-10, 1e-13, 0.0, -1e-13, -1e-10, -1e-9, -1e-6, -1e-3})
    for (const double speed : {100.0, 1e3}) {
      CAPTURE(depth);
      CAPTURE(speed);
      // closest in the middle of the third step, moving across the line of centres
      Ring ring(test::patch_of({{{0, 0, 0}}, {{0, 0, 2.0 * (1.0 - depth)}}}, 1e4, 1e4), {}, step);
      ring.particles.bodies[1].elements = elements_from(
          {{0.0, 0.0, 2.0 * (1.0 - depth)}, {0.6 * speed, 0.8 * speed, 0.0}}, {}, Rotation({}, 2.0 * step));
      const std::size_t contacts = walk(ring, 5);
      if (std::fabs(depth) > 2e-11) // the rounding of |d|² − R² where elements are of 2000 radii
        CHECK(contacts == (depth > 0.0 ? 1 : 0));
      else
        CHECK(contacts <= 1);
    }
}

TEST_CASE("simultaneous and triple contacts") {
  const double step = two_pi * 1e-5;
  std::vector<Sphere> spheres{
      {{0, 0, 0}}, {{0, 0, 2.01}, {0, 0, -1e3}}, {{0, 0, -2.01}, {0, 0, 1e3}}}; // from both sides
  for (int k = 0; k < 3; ++k) {                                                 // three that close in on one point
    const Vec3 out(std::cos(two_pi * k / 3), std::sin(two_pi * k / 3), 0.0);
    spheres.push_back({Vec3(20, 0, 0) + (2.0 / std::sqrt(3.0) + 0.01) * out, -1e3 * out});
  }
  for (int k = 0; k < 4; ++k) { // and four; then pairs that all meet at one instant
    const Vec3 out(std::cos(0.5 * pi * k), std::sin(0.5 * pi * k), 0.0);
    spheres.push_back({Vec3(-20, 0, 0) + (std::sqrt(2.0) + 0.01) * out, -1e3 * out});
    spheres.push_back({{0.0, 20.0 + 4.0 * k, 1.01}, {0, 0, -500}});
    spheres.push_back({{0.0, 20.0 + 4.0 * k, -1.01}, {0, 0, 500}});
  }
  for (const double kept : {0.0, 0.5, 1.0})
    for (const bool reversed : {false, true}) {
      Ring ring(test::patch_of(spheres, 100.0, 100.0), restitution(kept), step);
      if (reversed) {
        std::reverse(ring.particles.bodies.begin(), ring.particles.bodies.end());
        std::reverse(ring.particles.ids.begin(), ring.particles.ids.end());
      }
      CHECK(walk(ring, 5, restitution(kept)) >= 2 + 3 + 4 + 4);
    }
}

TEST_CASE("Newton's cradle: what hits a row of spheres at rest flies on from its other end") {
  // co-orbital spheres: at rest they stay; in a millionth of an orbit the tide adds 6e-6 of the speed
  const double step = two_pi * 1e-6;
  for (const int count : {5, 300})
    for (const double gap : {0.0, 1e-8}) {
      CAPTURE(count);
      CAPTURE(gap);
      std::vector<Sphere> row{{{0, -300.0 - 1e-7, 0}, {0, 1.0, 0}}};
      for (int k = 1; k <= count; ++k)
        row.push_back({{0, -300.0 + (2.0 + gap) * k, 0}});
      Ring ring(test::patch_of(row, 50.0, 700.0), restitution(1.0), step);
      CHECK(walk(ring, 2, restitution(1.0)) == static_cast<std::size_t>(count));
      for (std::size_t k = 0; k < row.size(); ++k) {
        const Vec3 v = state_at(ring.particles.bodies[k].elements, {}, Rotation()).velocity;
        CHECK(std::fabs(v.y() - (k + 1 == row.size() ? 1.0 : 0.0)) < 1e-4);
      }
    }
}

TEST_CASE("point-symmetric states stay symmetric to the bit") {
  test::RandomVectors random(12);
  std::vector<Sphere> half;
  while (half.size() < 50) { // a ball that falls together; sphere k and sphere k + 50 are opposite
    const Vec3 place = 12.0 * std::cbrt(random.uniform()) * random.direction();
    const bool free = place.norm() > 1.01 && std::none_of(half.begin(), half.end(), [&](const Sphere& s) {
                        return std::min((s.position - place).norm(), (s.position + place).norm()) < 2.01;
                      });
    if (free)
      half.push_back({place, Vec3(0.0, 1.5 * place.x(), 0.0) - 2.0 * place + random.direction()});
  }
  std::vector<Sphere> spheres = half;
  for (const Sphere& s : half)
    spheres.push_back({-s.position, -s.velocity});
  for (const double step : {1e-4, 3e-3, 3e-2}) {
    CAPTURE(step);
    Ring ring(test::patch_of(spheres, 2000.0, 2000.0), {}, two_pi * step); // no edge in reach
    CHECK(walk(ring, 40) > (step < 1e-3 ? 0 : 20));
    for (std::size_t k = 0; k < 50; ++k) {
      const Elements a = ring.particles.bodies[k].elements, b = ring.particles.bodies[k + 50].elements;
      CHECK(a.guiding_x == -b.guiding_x);
      CHECK(a.guiding_y == -b.guiding_y);
      CHECK(a.e_cos == -b.e_cos);
      CHECK(a.e_sin == -b.e_sin);
      CHECK(a.i_sin == -b.i_sin);
      CHECK(a.i_cos == -b.i_cos);
    }
  }
}

TEST_CASE("a storm of contacts ends with a message, not in a hang") {
  // a closed row without gaps: what hits it runs around it for ever in no time
  std::vector<Sphere> row;
  for (int k = 0; k < 3; ++k)
    row.push_back({{0, 2.0 * k - 3.0, 0}, {0, k == 0 ? 1.0 : 0.0, 0}});
  Ring ring(test::patch_of(row, 20.0, 6.0), restitution(1.0), two_pi * 1e-3);
  try {
    ring.advance();
    FAIL("no storm");
  } catch (const InvariantError& error) {
    const std::string text = error.what();
    CHECK(text.find("particle") != std::string::npos);
    CHECK(text.find("event storm") != std::string::npos);
    CHECK(text.find("collisions.elastic_below_speed") != std::string::npos);
  }
}

} // namespace extremes_test
