// Contacts at rest: exact motions of two bodies, a sphere that bounces to rest, conservation laws, and identical bits
// for any number of threads and after a restart.
#include <keeler/cells/overlap.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace resting_test {

using namespace keeler;
using namespace keeler::simulation;

namespace {

constexpr double omega = 1.3e-4; // rad/s

// Two bodies without images of each other.
Scene scene_of_two(double density, double step, const std::string& more) {
  return parse_scene(
      fmt::format("planet.orbital_frequency = {}\nbox.size = [200, 200]\n"
                  "particles = {{ count = 2, density = {}, sizes = {{ law = \"equal\", radius = 1.0 }} }}\n"
                  "gravity = {{ solver = \"direct\", images = \"rings\", image_rings = 0, kick_every = 1 }}\n"
                  "time = {{ step = {}, end = 10.0 }}\n{}",
                  omega, density, step, more),
      "test scene");
}

// Puts the first body at the origin, where it stays if it is much heavier, or else both about the origin.
Patch two(const Scene& scene, const Vec3& place, const Vec3& velocity, double heavier = 1.0) {
  Patch patch;
  const double mass = 4.0 / 3.0 * pi * scene.particles.density, share = 1.0 / (1.0 + heavier);
  patch.positions = {-share * place, (1.0 - share) * place};
  patch.velocities = {-share * velocity, (1.0 - share) * velocity};
  patch.radii = {1.0, 1.0};
  patch.masses = {heavier * mass, mass};
  patch.ids = {0, 1};
  patch.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
  patch.frequencies = scene.planet.frequencies;
  patch.orbital_frequency = omega;
  return patch;
}

// Two spheres that touch are a dumbbell in the planet's tide. With κ = ν = Ω = 1 and θ the angle of their line of
// centres from the radial direction, Hill's equations along the arc give θ'' = −(3/2c) sin 2θ: c = 1 for smooth
// spheres, and 1 + 2I/(μ d²) = 1.4 for rough ones, which rotate rigidly (I = 2/5 m r² each, μ = m/2, d = 2r).
double largest_error_of_swing(const std::string& surface, double inertia, double step, double start_angle) {
  const Scene scene =
      scene_of_two(3000.0, step, "collisions.restitution = { law = \"constant\", value = 0.3 }\n" + surface);
  Patch start = two(scene, 2.0 * (1.0 + 1e-12) * Vec3(std::cos(start_angle), std::sin(start_angle), 0.0), Vec3::Zero());
  if (!surface.empty())
    start.spins = {Vec3::UnitZ(), Vec3::UnitZ()};
  Simulation simulation(scene, start);
  double angle = start_angle, rate = 0.0, largest = 0.0;
  const auto pull = [&](double a) { return -1.5 / inertia * std::sin(2.0 * a); };
  for (int k = 0; simulation.orbits() < 2.0; ++k) {
    simulation.advance();
    constexpr int parts = 8; // Störmer–Verlet, with steps short enough to neglect its error
    const double part = two_pi * step / parts;
    for (int p = 0; p < parts; ++p) {
      rate += 0.5 * part * pull(angle);
      angle += part * rate;
      rate += 0.5 * part * pull(angle);
    }
    const Patch now = simulation.patch();
    const Vec3 line = now.positions[1] - now.positions[0];
    CHECK(line.norm() > 2.0 * (1.0 - 1e-12));
    largest = std::max(largest, std::fabs(std::remainder(std::atan2(line.y(), line.x()) - angle, two_pi)));
  }
  CHECK(simulation.state().resting.pairs.size() == 1);
  CHECK(simulation.state().collisions.slow + simulation.state().collisions.fast < 20); // else they bounce all the time
  return largest;
}

void run_until(Simulation& simulation, double orbits) {
  while (simulation.orbits() < orbits - 1e-12)
    simulation.advance();
}

Scene pile_scene(const std::string& more) {
  return parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [40, 40]\n"
                     "time = { step = 2e-3, end = 1.0 }\ngravity = { solver = \"direct\", kick_every = 2 }\n" +
                         more +
                         "[particles]\ncount = 60\ndensity = 1500.0\nsizes = { law = \"equal\", radius = 1.0 }\n"
                         "[[particles.aggregate]]\ncount = 60\nposition = [0, 0, 0]\nfilling_factor = 0.45\n",
                     "test scene");
}

bool same_bits(const SimulationState& a, const SimulationState& b) {
  const auto same = [](const auto& left, const auto& right) {
    return left.size() == right.size() &&
           (left.empty() || std::memcmp(left.data(), right.data(), left.size() * sizeof(left[0])) == 0);
  };
  return same(a.particles.bodies, b.particles.bodies) && same(a.particles.ids, b.particles.ids) &&
         same(a.particles.spins, b.particles.spins) && same(a.resting.pairs, b.resting.pairs) &&
         same(a.resting.loads, b.resting.loads) && a.resting.work == b.resting.work &&
         a.collisions.momentum_flux == b.collisions.momentum_flux;
}

} // namespace

TEST_CASE("two smooth spheres at rest on each other swing as a dumbbell") {
  const double coarse = largest_error_of_swing("", 1.0, 5e-3, 0.5),
               fine = largest_error_of_swing("", 1.0, 1.25e-3, 0.5);
  MESSAGE("error of the angle, rad: " << coarse << " at 1/200 orbit, " << fine << " at 1/800");
  CHECK(coarse < 5e-3);
  CHECK(fine < 0.1 * coarse); // second order: a sixteenth
}

TEST_CASE("two rough spheres roll on each other as one body") {
  const std::string rough = "collisions.friction = { tangential_restitution = 0.0 }\n";
  const double coarse = largest_error_of_swing(rough, 1.4, 5e-3, 0.5),
               fine = largest_error_of_swing(rough, 1.4, 1.25e-3, 0.5);
  MESSAGE("error of the angle, rad: " << coarse << " at 1/200 orbit, " << fine << " at 1/800");
  CHECK(coarse < 0.1);
  CHECK(fine < 0.35 * coarse); // they roll a step behind: first order, a quarter
}

// On the radial line through both, tides pull by 3 Ω² d and gravity by 2 G m / d²: equal where r_h = 1.
TEST_CASE("tides part two spheres that touch where r_h is below 1, and not above") {
  for (const double r_h : {0.9, 0.98, 1.02, 1.1}) {
    const double density = 9.0 * r_h * r_h * r_h / (pi * newton_g(omega));
    const Scene scene = scene_of_two(density, 2e-3, "collisions.restitution = { law = \"constant\", value = 0.3 }\n");
    Simulation simulation(scene, two(scene, Vec3(2.0 * (1.0 + 1e-12), 0.0, 0.0), Vec3::Zero()));
    run_until(simulation, 1.0);
    const Patch now = simulation.patch();
    const double gap = (now.positions[1] - now.positions[0]).norm() - 2.0;
    CAPTURE(r_h);
    CAPTURE(gap);
    CHECK((r_h < 1.0 ? gap > 1.0 : gap < 1e-3));
    CHECK(simulation.state().resting.pairs.empty() == (r_h < 1.0));
  }
}

// Along the vertical through a heavy sphere motion is one-dimensional: z'' = −GM/z² − z. A sphere dropped on it
// bounces at restitution 0.5 until a kick reverses its rebound, and rests from then on.
TEST_CASE("a dropped sphere bounces as it should, and then rests") {
  constexpr double step = 2.5e-4, heavier = 30.0, height = 3.0;
  const Scene scene = scene_of_two(900.0, step, "collisions.restitution = { law = \"constant\", value = 0.5 }\n");
  struct Bounces : collision::DriftObserver {
    std::vector<double> speeds;
    void collided(const collision::CollisionRecord& record) override { speeds.push_back(record.normal_speed); }
  } bounces;
  Simulation simulation(scene, two(scene, Vec3(0.0, 0.0, height), Vec3::Zero(), heavier));
  simulation.drift().observe(&bounces);
  const double pull = newton_g(omega) * (1.0 + heavier) * 4.0 / 3.0 * pi * 900.0;
  const auto potential = [&](double z) { return -pull / z + 0.5 * z * z; };
  double speed = std::sqrt(2.0 * (potential(height) - potential(2.0)));
  const double first = speed;
  run_until(simulation, 0.2);
  const double kick = pull / 4.0 * two_pi * step;
  std::size_t resolved = 0;
  for (; speed > 10.0 * kick; ++resolved, speed *= 0.5) {
    REQUIRE(bounces.speeds.size() > resolved);
    CHECK(bounces.speeds[resolved] == doctest::Approx(speed).epsilon(kick / speed));
  }
  CHECK(resolved >= 3);
  CHECK(bounces.speeds.size() < 40);
  const std::size_t so_far = bounces.speeds.size();
  run_until(simulation, 0.4); // at rest, to far below the speed of a kick
  CHECK(bounces.speeds.size() == so_far);
  const Patch end = simulation.patch();
  CHECK((end.positions[1] - end.positions[0]).norm() == doctest::Approx(2.0).epsilon(1e-4));
  CHECK((end.velocities[1] - end.velocities[0]).norm() < 0.02 * kick); // the tolerance of gaps
  const double dropped = 0.5 * first * first, mass = end.masses[1] * heavier / (1.0 + heavier);
  CHECK(simulation.balance().lost - simulation.balance().resting_work ==
        doctest::Approx(mass * dropped).epsilon(0.02)); // the energy of the fall is dissipated
}

TEST_CASE("a pile keeps its momentum, and its energy is booked") {
  const Scene scene = pile_scene("");
  Simulation simulation(scene, initial_patch(scene));
  const auto centre = [&] { // of mass, as an orbit at the epoch
    Elements sum{};
    double mass = 0.0;
    for (const Body& b : simulation.state().particles.bodies) {
      const Elements& el = b.elements;
      mass += b.mass;
      sum = {sum.guiding_x + b.mass * el.guiding_x, sum.guiding_y + b.mass * el.guiding_y,
             sum.e_cos + b.mass * el.e_cos,         sum.e_sin + b.mass * el.e_sin,
             sum.i_sin + b.mass * el.i_sin,         sum.i_cos + b.mass * el.i_cos};
    }
    return std::array{sum.guiding_x / mass, std::hypot(sum.e_cos, sum.e_sin) / mass,
                      std::hypot(sum.i_sin, sum.i_cos) / mass};
  };
  const auto before = centre();
  run_until(simulation, 0.6);
  REQUIRE(simulation.state().resting.pairs.size() > 60);
  const auto after = centre();
  const double wrap = scene.size_x / 60.0; // of one particle
  CHECK(std::fabs(std::remainder(after[0] - before[0], wrap)) < 1e-9);
  for (std::size_t k = 1; k < before.size(); ++k)
    CHECK(std::fabs(after[k] - before[k]) < 1e-9);
  const EnergyBalance balance = simulation.balance();
  CHECK(std::fabs(balance.residual) < 1e-9 * balance.lost);
  CHECK(cells::largest_overlap(simulation.patch()).depth == 0.0);
}

// A pile at rest conserves its Jacobi energy: nothing more is lost.
TEST_CASE("a pile comes to rest") {
  const Scene scene = pile_scene("collisions.restitution = { law = \"constant\", value = 0.5 }\n");
  Simulation simulation(scene, initial_patch(scene));
  run_until(simulation, 1.0);
  const double lost = simulation.balance().lost;
  run_until(simulation, 1.2);
  // per orbit 1/200 of its binding energy, at least 3/5 G M²/R
  const double mass = 60.0 * simulation.state().particles.bodies[0].mass, radius = std::cbrt(60.0 / 0.5);
  CHECK((simulation.balance().lost - lost) / 0.2 <
        0.005 * 0.6 * newton_g(scene.planet.orbital_frequency) * mass * mass / radius);
}

TEST_CASE("piles have the same bits for any threads and over a restart, rough ones too") {
  for (const std::string more : {"", "collisions.friction = { tangential_restitution = 0.5 }\n"}) {
    CAPTURE(more);
    const Scene scene = pile_scene(more);
    const Patch start = initial_patch(scene);
    set_threads(1);
    Simulation once(scene, start);
    run_until(once, 0.2);
    REQUIRE(!once.state().resting.pairs.empty());
    for (const int count : {2, 3}) {
      set_threads(count);
      Simulation again(scene, start);
      run_until(again, 0.12);
      Simulation resumed(scene, again.state());
      run_until(resumed, 0.2);
      CHECK(same_bits(once.state(), resumed.state()));
    }
    set_threads(1);
  }
}

} // namespace resting_test
