#include <keeler/core/field_table.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace forces_test {

using namespace keeler;
using namespace keeler::simulation;

namespace {

// One particle of zero eccentricity and inclination where X = Y = 0, and an acceleration in m rad⁻².
struct Pushed {
  Scene scene;
  Simulation simulation;

  Pushed(const std::string& component, double acceleration, double step, const std::string& more = {})
      : scene(make_scene(component, acceleration, step, more)), simulation(scene, at_rest(scene)) {}

  static Scene make_scene(const std::string& component, double acceleration, double step, const std::string& more) {
    const double omega = 2e-4;
    return parse_scene("planet = { orbital_frequency = 2e-4, epicyclic_ratio = 0.98, vertical_ratio = 1.02 }\n"
                       "box.size = [1000.0, 1000.0]\n"
                       "particles = { count = 1, density = 900.0, sizes = { law = \"equal\", radius = 1.0 } }\n"
                       "time = { step = " +
                           std::to_string(step) + ", end = 1.0 }\n[constant_acceleration]\n" + component + " = " +
                           std::to_string(acceleration * omega * omega * 1e9) + "e-9\n" + more,
                       "test scene");
  }

  static Patch at_rest(const Scene& scene) {
    Patch patch;
    patch.positions = patch.velocities = {Vec3::Zero()};
    patch.radii = {1.0};
    patch.masses = {1000.0};
    patch.ids = {0};
    patch.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
    patch.frequencies = scene.planet.frequencies;
    patch.orbital_frequency = scene.planet.orbital_frequency;
    return patch;
  }

  // The largest departure from an exact solution over an orbit.
  template<class Exact> double error(const Exact& exact) {
    double largest = 0.0;
    while (simulation.orbits() < 1.0 - 1e-9) {
      simulation.advance();
      const Vec3 wrong = simulation.patch().positions[0] - exact(two_pi * simulation.orbits());
      largest = std::max(largest, wrong.norm());
    }
    return largest;
  }
};

} // namespace

// Hill's equations with a constant acceleration a, from rest at the origin: a vertical one lifts the middle of the
// oscillation to a/ν²; an azimuthal one makes the orbit grow by 2Ωa/κ² per radian of the orbit.
TEST_CASE("a constant acceleration does what Hill's equations say, to second order in the step") {
  const double a = 0.3, nu = 1.02, kappa = 0.98;
  const auto lifted = [&](double t) { return Vec3(0.0, 0.0, a / (nu * nu) * (1.0 - std::cos(nu * t))); };
  const double coarse = Pushed("vertical", a, 1e-2).error(lifted), fine = Pushed("vertical", a, 5e-3).error(lifted);
  CHECK(fine < 2e-4 * a);
  CHECK(coarse / fine == doctest::Approx(4.0).epsilon(0.02));

  const auto driven = [&](double t) { // ẍ = 2ẏ + (4 − κ²) x, ÿ = −2ẋ + a
    const double k2 = kappa * kappa, x = 2.0 * a / k2 * (t - std::sin(kappa * t) / kappa);
    const double integral = 2.0 * a / k2 * (0.5 * t * t + (std::cos(kappa * t) - 1.0) / k2); // of x
    return Vec3(x, 0.5 * a * t * t - 2.0 * integral, 0.0);
  };
  const double coarse_y = Pushed("azimuthal", a, 1e-2).error(driven),
               fine_y = Pushed("azimuthal", a, 5e-3).error(driven);
  CHECK(fine_y < 2e-2 * a);
  CHECK(coarse_y / fine_y == doctest::Approx(4.0).epsilon(0.02));
}

TEST_CASE("the work of a force is booked under its name, and the energy budget closes") {
  Pushed pushed("azimuthal", 0.3, 1e-3);
  for (int k = 0; k < 500; ++k)
    pushed.simulation.advance();
  const SimulationState& state = pushed.simulation.state();
  REQUIRE(state.forces.size() == 1);
  CHECK(state.forces[0].name == "constant_acceleration");
  CHECK(std::fabs(state.forces[0].work) > 1.0);
  CHECK(state.kick_work() == state.forces[0].work);
  CHECK(std::fabs(pushed.simulation.balance().residual) < 1e-12 * std::fabs(state.forces[0].work));
  CHECK(pushed.simulation.time_split().force("constant_acceleration") > 0.0);
  CHECK(pushed.simulation.time_split().force("gravity") == 0.0);
}

TEST_CASE("with self-gravity a force comes after it, and each keeps its own kick interval") {
  Pushed pushed("vertical", 0.1, 1e-3, "[gravity]\nsolver = \"direct\"\nkick_every = 4\n");
  for (int k = 0; k < 8; ++k)
    pushed.simulation.advance();
  const SimulationState& state = pushed.simulation.state();
  REQUIRE(state.forces.size() == 2);
  CHECK(state.forces[0].name == "gravity");
  CHECK(state.forces[1].name == "constant_acceleration");
  CHECK(std::fabs(state.forces[0].work) < 1e-30); // alone: its images pull evenly
  CHECK(state.forces[1].accelerations[0].z() == doctest::Approx(0.1));
  const double t = 8e-3 * two_pi;
  CHECK(pushed.simulation.patch().velocities[0].z() == doctest::Approx(0.1 * t).epsilon(1e-2));
}

TEST_CASE("a run with two forces goes on from its fields to the bit") {
  const std::string gravity = "[gravity]\nsolver = \"direct\"\nkick_every = 2\n";
  Pushed straight("azimuthal", 0.3, 1e-3, gravity), half("azimuthal", 0.3, 1e-3, gravity);
  for (int k = 0; k < 10; ++k)
    straight.simulation.advance();
  for (int k = 0; k < 4; ++k)
    half.simulation.advance();
  SimulationState from = half.simulation.state(), into(half.scene);
  FieldTable source = from.fields(), target = into.fields();
  REQUIRE(source.fields().size() == target.fields().size());
  for (std::size_t k = 0; k < source.fields().size(); ++k) {
    const Field &a = source.fields()[k], &b = target.fields()[k];
    b.resize(a.rows());
    std::copy_n(static_cast<const char*>(a.data()), a.bytes(), static_cast<char*>(b.data()));
  }
  Simulation resumed(half.scene, into);
  for (int k = 0; k < 6; ++k)
    resumed.advance();
  const Body &a = resumed.state().particles.bodies[0], &b = straight.simulation.state().particles.bodies[0];
  CHECK(a.elements.guiding_x == b.elements.guiding_x);
  CHECK(a.elements.guiding_y == b.elements.guiding_y);
  CHECK(a.elements.e_cos == b.elements.e_cos);
  CHECK(resumed.state().kick_work() == straight.simulation.state().kick_work());
}

TEST_CASE("the energy of self-gravity is what a meter of its own says, and to measure it changes no bit") {
  for (const char* solver : {"direct", "tree", "fft", "mesh", "auto"}) {
    CAPTURE(solver);
    const Scene scene = parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [40, 30]\ntime.end = 1.0\n"
                                    "particles = { count = 200, density = 600.0, sizes = { law = \"power\", exponent = "
                                    "3.0, min = 0.4, max = 1.5 } }\n[gravity]\nresting_contacts = \"bounced\"\n",
                                    "test scene", {std::string("gravity.solver=") + solver});
    Simulation measured(scene, initial_patch(scene)), plain(scene, initial_patch(scene));
    for (int k = 0; k < 6; ++k) {
      measured.gravity_energy();
      measured.advance();
      plain.advance();
    }
    const std::optional<gravity::GravityEnergy> energy = measured.gravity_energy();
    REQUIRE(energy.has_value());
    for (std::size_t k = 0; k < 200; ++k) {
      const Elements &a = measured.state().particles.bodies[k].elements,
                     &b = plain.state().particles.bodies[k].elements;
      CHECK((a.e_cos == b.e_cos && a.i_sin == b.i_sin && a.guiding_y == b.guiding_y));
    }
    std::vector<Vec3> positions;
    std::vector<double> masses;
    const gravity::GravityProblem problem =
        gravity_problem(plain.boundary(), scene.planet.orbital_frequency, positions, masses);
    const gravity::GravityEnergy own = make_energy_meter(*scene.gravity, masses, problem.box.area())->energy(problem);
    CHECK(energy->potential == own.potential);
    CHECK(energy->stress == own.stress);
    CHECK(energy->potential != 0.0);
  }
}

TEST_CASE("a scene has no energy of gravity without it, nor with some rings of images") {
  for (const char* gravity : {"", "[gravity]\nsolver = \"direct\"\nimages = \"rings\"\n"}) {
    Pushed pushed("vertical", 0.1, 1e-3, gravity);
    CHECK_FALSE(pushed.simulation.gravity_energy().has_value());
  }
}

} // namespace forces_test
