// A satellite that passes the box: against the impulse of the linear theory, Hill's equations integrated to the end of
// the passage, and a ring's streamlines downstream.
#include <keeler/core/field_table.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/forces/satellite.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace satellite_test {

using namespace keeler;
using namespace keeler::simulation;

namespace {

constexpr double distance = 1e5; // of the satellite, m

// e of a circular orbit after the passage of a body at a distance d on a circular orbit, in d, to first order in
// h = G m/(Ω² d³), for κ = Ω: 8/9 [2 K₀(2/3) + K₁(2/3)] h (Goldreich & Tremaine 1980; Petit & Hénon 1986).
constexpr double impulse = 2.2396;

// G m/(Ω² distance³) of that size, and keys of [satellite] more.
Scene scene_with(double h, const std::string& more, double end) {
  const double omega = 2e-4, mass = h * std::pow(distance, 3) / newton_g(omega);
  return parse_scene(
      fmt::format("planet.orbital_frequency = {}\nbox.size = [4e4, 2e3]\n"
                  "particles = {{ count = 5, density = 900.0, sizes = {{ law = \"equal\", radius = 1.0 }} }}\n"
                  "time = {{ step = 4e-3, end = {} }}\n[satellite]\nmass = {}\ndistance = {}\n{}",
                  omega, end, mass, distance, more),
      "test scene");
}

// One particle on each of some circular orbits.
Patch circles(const Scene& scene, const std::vector<double>& guiding_x) {
  Patch patch;
  patch.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
  patch.frequencies = scene.planet.frequencies;
  patch.orbital_frequency = scene.planet.orbital_frequency;
  for (const double x : guiding_x) {
    patch.ids.push_back(patch.size());
    patch.positions.emplace_back(x, 0.0, 0.0);
    patch.velocities.emplace_back(0.0, -patch.box.shear * x, 0.0);
    patch.radii.push_back(1.0);
    patch.masses.push_back(1e3);
  }
  return patch;
}

struct After {
  double gained_x, eccentricity, phase; // phase: of the epicycle now
};

After after(const Simulation& simulation, const Patch& start, std::size_t k) {
  const Patch patch = simulation.patch();
  const Elements el = elements_from({patch.positions[k], patch.velocities[k]}, patch.frequencies, Rotation());
  return {el.guiding_x - start.positions[k].x(), el.eccentricity(), std::atan2(el.e_sin, el.e_cos)};
}

void run(Simulation& simulation, double orbits) {
  while (simulation.orbits() < orbits - 1e-9)
    simulation.advance();
}

// X of a circular orbit that the approach to the satellite has moved, long before and long after: 2 G m/(S d² √(1 +
// S²τ²)) towards it, τ from the passage.
double tail(double h, double d, double orbits_from_passage) {
  return 2.0 * h * std::pow(distance, 3) / (1.5 * d * d * std::hypot(1.0, 1.5 * two_pi * orbits_from_passage));
}

double relative(double value, double expected) {
  return std::fabs(value / expected - 1.0);
}

double angle_between(double a, double b) {
  return std::fabs(std::remainder(a - b, two_pi));
}

// Brute force: Hill's equations of a particle and a satellite of fixed orbit, with y unwrapped.
struct HillPassage {
  double pull, x_s, e_s, phase, passage;

  State slope(const State& s, double t) const {
    const double turned = t - passage + phase;
    const Vec3 body(x_s - e_s * std::cos(turned), -1.5 * x_s * (t - passage) + 2.0 * e_s * std::sin(turned), 0.0);
    const Vec3 away = body - s.position, a = pull / std::pow(away.norm(), 3) * away;
    const Vec3 v = s.velocity;
    return {v, Vec3(2.0 * v.y() + 3.0 * s.position.x(), -2.0 * v.x(), 0.0) + a};
  }

  // Integrates by the classical Runge–Kutta method.
  State end(State s, double time) const {
    constexpr double h = 2e-3;
    const auto moved = [](const State& from, double by, const State& along) {
      return State{from.position + by * along.position, from.velocity + by * along.velocity};
    };
    for (std::int64_t n = 0; n < std::llround(time / h); ++n) {
      const double t = static_cast<double>(n) * h;
      const State k1 = slope(s, t), k2 = slope(moved(s, 0.5 * h, k1), t + 0.5 * h);
      const State k3 = slope(moved(s, 0.5 * h, k2), t + 0.5 * h), k4 = slope(moved(s, h, k3), t + h);
      for (const auto& [k, weight] : {std::pair{&k1, 1.0}, {&k2, 2.0}, {&k3, 2.0}, {&k4, 1.0}})
        s = moved(s, h * weight / 6.0, *k);
    }
    return s;
  }
};

} // namespace

TEST_CASE("a passage makes the eccentricity of the impulse, and moves orbits away by 2/3 e²/d") {
  const double h = 1e-4;
  const Scene scene = scene_with(h, "passage = 15.0\n", 30.0);
  const Patch start = circles(scene, {0.0, 1.5e4, -1.5e4});
  Simulation simulation(scene, start);
  run(simulation, 30.0);
  for (const std::size_t k : {0u, 1u, 2u}) {
    const double d = distance - start.positions[k].x(), e = impulse * h * std::pow(distance, 3) / (d * d);
    const After now = after(simulation, start, k);
    const double gained = -2.0 / 3.0 * e * e / d;
    MESSAGE("X " << start.positions[k].x() << ": e " << now.eccentricity / e << ", dX " << now.gained_x / gained);
    CAPTURE(k);
    CHECK(relative(now.eccentricity, e) < 2e-3);
    CHECK(relative(now.gained_x, gained) < 1e-2); // the tails cancel: as long before as after
    // pulled outward at the passage, which is at one time for all
    CHECK(angle_between(now.phase, 0.5 * pi + two_pi * 15.0) < 5e-3);
  }
}

// At the time when the column is upright, |y| behind the satellite, a streamline has met it |y|/(3/2 d) ago: its
// wave along the orbit has the wavelength 3π d (Showalter et al. 1986).
TEST_CASE("streamlines downstream have the phases of a wave of wavelength 3 pi d, when they stand side by side") {
  const double h = 1e-4, behind = 12.0; // orbits
  const Scene scene = scene_with(h, fmt::format("passage = 10.0\ndownstream_time = {}\n", behind), 22.0);
  const std::vector<double> places = {-1.5e4, -6e3, 0.0, 6e3, 1.5e4};
  const Patch start = circles(scene, places);
  Simulation simulation(scene, start);
  run(simulation, 10.0 + behind);
  const double y = 1.5 * distance * two_pi * behind;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double d = distance - places[k];
    const After now = after(simulation, start, k);
    const double e = impulse * h * std::pow(distance, 3) / (d * d);
    const double passed = 10.0 - places[k] * behind / d; // orbits
    const double gained = -2.0 / 3.0 * e * e / d;
    const double tails = tail(h, d, 10.0 + behind - passed) - tail(h, d, passed);
    MESSAGE("X " << places[k] << ": e " << now.eccentricity / e << ", dX " << (now.gained_x - tails) / gained);
    CAPTURE(k);
    CHECK(angle_between(now.phase, 0.5 * pi + two_pi * y / (3.0 * pi * d)) < 2e-2);
    CHECK(relative(now.eccentricity, e) < 5e-3);
    CHECK(relative(now.gained_x - tails, gained) <
          5e-2); // with the current X in the time of the passage: 26 times too large
  }
}

TEST_CASE("an eccentric satellite does what Hill's equations say") {
  const double h = 2e-5, e_s = 0.2 * distance;
  for (const double phase : {0.0, 90.0, 200.0}) {
    const Scene scene =
        scene_with(h, fmt::format("passage = 8.0\neccentricity = {}\neccentricity_phase = {}\n", e_s, phase), 16.0);
    const Patch start = circles(scene, {0.0});
    Simulation simulation(scene, start);
    run(simulation, 16.0);
    const HillPassage exact{h * std::pow(distance, 3), distance, e_s, phase * pi / 180.0, two_pi * 8.0};
    const Elements el = elements_from(exact.end({}, two_pi * 16.0), Frequencies(), Rotation());
    const After now = after(simulation, start, 0);
    CAPTURE(phase);
    CHECK(relative(now.eccentricity, el.eccentricity()) < 2e-3);
    CHECK(angle_between(now.phase, std::atan2(el.e_sin, el.e_cos)) < 5e-3);
    CHECK(std::fabs(now.gained_x - el.guiding_x) < 2e-3 * h * distance); // to first order in h
  }
}

TEST_CASE("passages come back after the synodic period of each streamline, and their eccentricities add as vectors") {
  const double h = 1e-6, every = 20.37;
  const Scene scene = scene_with(h, fmt::format("passage = 8.0\nevery = {}\n", every), 40.0);
  const Patch start = circles(scene, {0.0, 1e4});
  Simulation simulation(scene, start);
  run(simulation, 40.0);
  for (const std::size_t k : {0u, 1u}) {
    const double d = distance - start.positions[k].x(), e = impulse * h * std::pow(distance, 3) / (d * d);
    const double turns = two_pi * every * distance / d; // between the passages
    CAPTURE(k);
    CHECK(relative(after(simulation, start, k).eccentricity, e * std::sqrt(2.0 + 2.0 * std::cos(turns))) < 2e-2);
  }
}

TEST_CASE("an inclined satellite lifts the ring, and a level one does not") {
  const Scene level = scene_with(1e-4, "passage = 3.0\n", 6.0);
  const Scene inclined = scene_with(1e-4, "passage = 3.0\ninclination = 2e4\ninclination_phase = 90.0\n", 6.0);
  const Patch start = circles(level, {0.0});
  Simulation flat(level, start), lifted(inclined, start);
  run(flat, 6.0);
  run(lifted, 6.0);
  CHECK(flat.state().particles.bodies[0].elements.inclination() == 0.0);
  const double i = lifted.state().particles.bodies[0].elements.inclination();
  CHECK(i > 0.1 * 1e-4 * 2e4); // of the order of h times its own
  CHECK(i < 10.0 * 1e-4 * 2e4);
}

TEST_CASE("a run with a satellite goes on from its fields to the bit, on any number of threads") {
  const Scene scene =
      parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [40.0, 40.0]\n"
                  "particles = { count = 300, density = 900.0, sizes = { law = \"equal\", radius = 0.8 } }\n"
                  "time = { step = 5e-3, end = 1.0 }\n"
                  "satellite = { mass = 1e7, distance = -200.0, passage = 0.3, every = 0.4, downstream_time = 1.0, "
                  "eccentricity = 9 "
                  "}\n",
                  "test scene");
  const Patch start = initial_patch(scene);
  const auto bits = [](const Simulation& simulation) {
    const Patch patch = simulation.patch();
    return std::pair(patch.positions, patch.velocities);
  };
  const int before = threads();
  set_threads(1);
  Simulation straight(scene, start);
  run(straight, 0.3);
  CHECK(std::fabs(straight.state().kick_work()) > 0.0);
  for (const int count : {2, 3}) {
    set_threads(count);
    Simulation half(scene, start);
    run(half, 0.11);
    SimulationState from = half.state(), into(scene);
    FieldTable source = from.fields(), target = into.fields();
    for (std::size_t k = 0; k < source.fields().size(); ++k) {
      target.fields()[k].resize(source.fields()[k].rows());
      std::copy_n(static_cast<const char*>(source.fields()[k].data()), source.fields()[k].bytes(),
                  static_cast<char*>(target.fields()[k].data()));
    }
    Simulation resumed(scene, into);
    run(resumed, 0.3);
    CHECK(bits(resumed) == bits(straight));
  }
  set_threads(before);
}

TEST_CASE("a satellite inside the box is refused, also where only a start file knows the box") {
  const std::string scene = "planet.preset = \"saturn-a-ring\"\nbox.size = [40.0, 40.0]\ntime.end = 1.0\n"
                            "particles = { count = 9, density = 900.0, sizes = { law = \"equal\", radius = 0.8 } }\n";
  const std::string satellite = "[satellite]\nmass = 1e3\ndistance = -25\npassage = 1\n";
  CHECK_NOTHROW(parse_scene(scene + satellite, "s.toml"));
  CHECK_THROWS_WITH_AS(
      parse_scene(scene + satellite + "eccentricity = 5\n", "s.toml"),
      "s.toml:5:1: satellite.distance = -25 m with its eccentricity of 5 m is inside the box (it reaches "
      "20 m from its middle); move it out, or make it a [[moonlet]]",
      UsageError);
  Patch wide = initial_patch(parse_scene(scene, "s.toml"));
  wide.box.size_x = 60.0;
  CHECK_THROWS_AS(Simulation(parse_scene(scene + satellite, "s.toml"), wide), UsageError);
}

namespace {

std::optional<forces::SatellitePassage> dragging(const Scene& scene, double least, double from, double until) {
  return forces::dragging_passage(scene.external_forces.front().parameters, scene.planet.orbital_frequency,
                                  scene.planet.frequencies, least, from, until);
}

} // namespace

// The speed of the sweep: the passage is at t(X) = (X_s t_0 − X t_u)/(X_s − X), so dX/dt = d/(t_0 − t_u).
TEST_CASE("the drag of a passage is the fastest that it moves a particle over the speed of its sweep") {
  const double upright = 40.0;
  const Scene scene = scene_with(1e-5, fmt::format("passage = 3.0\ndownstream_time = {}\n", upright), 6.0);
  const Patch start = circles(scene, {0.0});
  Simulation simulation(scene, start);
  double fastest = 0.0, before = 0.0, time = 0.0;
  while (simulation.orbits() < 6.0 - 1e-9) {
    simulation.advance();
    const double now = after(simulation, start, 0).gained_x, rad = two_pi * simulation.orbits();
    fastest = std::max(fastest, std::fabs(now - before) / (rad - time));
    before = now;
    time = rad;
  }
  const std::optional<forces::SatellitePassage> passage = dragging(scene, 0.0, 0.0, 6.0);
  REQUIRE(passage.has_value());
  CHECK(passage->orbits == 3.0);
  CHECK(relative(fastest / (distance / (two_pi * upright)), passage->drag) < 1e-2);
}

TEST_CASE("the passages that drag particles along are those far from the time when the cell stands upright") {
  // 0.77 · 1e-3 · 2π per orbit: 0.6 at 124 orbits from 30
  const Scene scene = scene_with(1e-3, "passage = 10.0\nevery = 25.0\ndownstream_time = 20.0\n", 1.0);
  CHECK(!dragging(scene, forces::doubtful_drag, 0.0, 150.0));
  const std::optional<forces::SatellitePassage> first = dragging(scene, forces::doubtful_drag, 0.0, 400.0);
  REQUIRE(first.has_value());
  CHECK(first->orbits == 160.0);
  CHECK(relative(first->drag, 4.0 / (3.0 * std::sqrt(3.0)) * 1e-3 * two_pi * 130.0) < 1e-9);
  CHECK(dragging(scene, forces::doubtful_drag, 160.0 + 1e-6, 400.0)->orbits == 185.0);
  CHECK(!dragging(scene, forces::doubtful_drag, 160.0 + 1e-6, 184.0));
  // before it
  const Scene late = scene_with(1e-3, "passage = 210.0\nevery = 100.0\ndownstream_time = 200.0\n", 1.0);
  CHECK(dragging(late, forces::doubtful_drag, 0.0, 1000.0)->orbits == 10.0);
  CHECK(dragging(late, forces::doubtful_drag, 250.0, 1000.0)->orbits == 610.0); // 310, 410 and 510 are near 410
  // without `every` there is one
  const Scene once = scene_with(1e-3, "passage = 10.0\ndownstream_time = 200.0\n", 1.0);
  CHECK(dragging(once, forces::doubtful_drag, 0.0, 1000.0)->orbits == 10.0);
  CHECK(!dragging(once, forces::doubtful_drag, 11.0, 1000.0));
}

} // namespace satellite_test
