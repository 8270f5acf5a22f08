#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

namespace gas_test {

using namespace keeler;

namespace {

// One particle in gas, κ and ν beside Ω.
struct Drifting {
  Scene scene;
  Simulation simulation;

  Drifting(double stopping_time, double head_wind, double step, const std::string& more = {})
      : scene(parse_scene("planet = { orbital_frequency = 2e-4, epicyclic_ratio = 0.98, vertical_ratio = 1.02 }\n"
                          "box.size = [1e6, 1e6]\n"
                          "particles = { count = 1, density = 900.0, sizes = { law = \"equal\", radius = 2.0 } }\n"
                          "time = { step = " +
                              std::to_string(step) +
                              ", end = 1.0 }\n[gas]\nstopping_time = " + std::to_string(stopping_time) +
                              "\nhead_wind = " + std::to_string(head_wind) + "\n" + more,
                          "test scene")),
        simulation(scene, moving(scene)) {}

  static Patch moving(const Scene& scene) {
    Patch patch;
    patch.positions = {Vec3::Zero()};
    patch.velocities = {Vec3(30.0, 10.0, 20.0)}; // m rad⁻¹
    patch.radii = {2.0};
    patch.masses = {1000.0};
    patch.ids = {0};
    patch.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
    patch.frequencies = scene.planet.frequencies;
    patch.orbital_frequency = scene.planet.orbital_frequency;
    return patch;
  }

  // c at orbit `until`
  Vec3 velocity(double until) {
    while (simulation.orbits() < until - 1e-9)
      simulation.advance();
    const forces::Boundary at = simulation.boundary();
    return peculiar_velocity(at.particles.bodies[0].elements, at.frequencies, at.rotation());
  }
};

// The solution of dc_x/dt = 2 c_y − c_x/τ, dc_y/dt = −½κ² c_x − (c_y + w)/τ and d²z/dt² = −ν² z − ż/τ.
Vec3 exact(double stopping_time, double head_wind, double orbits) {
  using Complex = std::complex<double>;
  const double tau = two_pi * stopping_time, w = head_wind / 2e-4, t = two_pi * orbits, kappa = 0.98, nu = 1.02;
  const double y = -w / (1.0 + kappa * kappa * tau * tau), x = 2.0 * tau * y; // terminal velocities
  const Complex turned = Complex(30.0 - x, 2.0 / kappa * (10.0 - y)) * std::exp(Complex(-1.0 / tau, -kappa) * t);
  const Complex root = std::sqrt(Complex(0.25 / (tau * tau) - nu * nu)), first = -0.5 / tau + root,
                second = -0.5 / tau - root;
  const Complex rise = 20.0 * (first * std::exp(first * t) - second * std::exp(second * t)) / (first - second);
  return {x + turned.real(), y + 0.5 * kappa * turned.imag(), rise.real()};
}

double error(double stopping_time, double step, const std::string& more = {}) {
  return (Drifting(stopping_time, 0.002, step, more).velocity(0.2) - exact(stopping_time, 0.002, 0.2)).norm();
}

} // namespace

TEST_CASE("gas drag is of second order in the step, and stays finite where the step is many stopping times") {
  for (const double stopping_time : {0.02, 0.16, 3.0}) {
    CAPTURE(stopping_time);
    const double coarse = error(stopping_time, 5e-3), fine = error(stopping_time, 2.5e-3);
    CHECK(coarse / fine == doctest::Approx(4.0).epsilon(0.06));
    CHECK(fine < 2e-3 * std::hypot(30.0, 10.0, 20.0));
  }
  const Vec3 stiff = Drifting(1e-4, 0.002, 1e-2).velocity(1.0); // a step of 100 stopping times
  CHECK(stiff.x() == doctest::Approx(-2.0 * 10.0 * two_pi * 1e-4).epsilon(1e-6));
  CHECK(stiff.y() == doctest::Approx(-10.0).epsilon(1e-6));
}

// Nakagawa, Sekiya & Hayashi 1986, Icarus 67, 375, for particles without mass and κ = Ω
TEST_CASE("a head wind makes particles drift inward at the terminal velocity, each by its size") {
  const double stopping_time = 0.16, w = 0.002 / 2e-4, kappa = 0.98;
  for (const double radius : {0.0, 1.0, 8.0}) { // the particle has 2 m
    CAPTURE(radius);
    const double tau = two_pi * stopping_time * (radius > 0.0 ? 2.0 / radius : 1.0);
    const Vec3 c = Drifting(stopping_time, 0.002, 1e-3, "radius = " + std::to_string(radius) + "\n").velocity(8.0);
    CHECK(c.x() == doctest::Approx(-2.0 * w * tau / (1.0 + kappa * kappa * tau * tau)).epsilon(1e-9));
    CHECK(c.y() == doctest::Approx(-w / (1.0 + kappa * kappa * tau * tau)).epsilon(1e-9));
  }
}

TEST_CASE("the work of gas drag is booked, and the energy budget closes") {
  Drifting drifting(0.16, 0.002, 1e-3);
  drifting.velocity(0.5);
  const simulation::SimulationState& state = drifting.simulation.state();
  REQUIRE(state.forces.size() == 1);
  CHECK(state.forces[0].name == "gas");
  CHECK(state.forces[0].work < -1.0);
  CHECK(std::fabs(drifting.simulation.balance().residual) < 1e-12 * std::fabs(state.forces[0].work));
}

} // namespace gas_test
