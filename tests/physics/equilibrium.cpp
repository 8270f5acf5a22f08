// The balance of viscous heating and collisional cooling without self-gravity, against published-method values: equal
// spheres of 1 m, κ = ν = Ω, made with REBOUND 6c44115f (time step 1e-3 orbit, N = 700–1500, 15–50 orbits); collision
// counts are those faster than v_cut = 1e-2 r Ω. Tolerance 5 %, 8 % at τ = 0.1: the scatter of boxes of this size.
#include "physics/scenes.hpp"

#include <doctest/doctest.h>

using namespace keeler;
using namespace keeler::test;

namespace {

Means equilibrium(double optical_depth, double step, const std::string& restitution, double dispersion,
                  int count = 1500, double settle = 12.0, double average = 15.0) {
  const Scene scene = spheres(optical_depth, count, step, restitution, 7, dispersion);
  Simulation simulation(scene, initial_patch(scene));
  const Means means = settle_and_average(simulation, scene, settle, average);
  MESSAGE("tau " << optical_depth << ", step " << step << ", " << restitution << ": c " << means.dispersion.transpose()
                 << ", H " << means.height << ", fast " << means.fast << ", slow " << means.slow << ", nu_coll "
                 << means.collisional_viscosity);
  return means;
}

constexpr const char* half = R"({ law = "constant", value = 0.5 })";

} // namespace

TEST_CASE("equilibrium at optical depth 0.5, with steps of 1/1000 and 1/100 orbit alike") {
  for (const double step : {1e-3, 1e-2}) {
    const Means means = equilibrium(0.5, step, half, 2.1);
    CHECK(means.dispersion.x() == doctest::Approx(2.175).epsilon(0.05));
    CHECK(means.dispersion.z() == doctest::Approx(1.45).epsilon(0.05));
    CHECK(means.fast == doctest::Approx(9.4).epsilon(0.05));
  }
}

TEST_CASE("equilibrium over optical depth and restitution law") {
  struct Reference {
    double optical_depth;
    const char* restitution;
    Vec3 dispersion;
    double height, collisional_viscosity, tolerance;
  };
  // The viscosity is the noisiest: 10 % there.
  const Reference references[] = {
      {0.1, half, {2.82, 1.41, 1.80}, 1.86, 0.063, 0.08},
      {0.5, half, {2.175, 1.21, 1.45}, 1.73, 0.378, 0.05},
      {1.0, half, {1.62, 1.07, 1.17}, 1.74, 0.821, 0.05},
      {0.5, R"({ law = "bridges", scale = 0.34 })", {2.80, 1.57, 1.91}, 2.22, 0.402, 0.05},
  };
  for (const Reference& r : references) {
    // collisions are rare at low optical depth: it settles more slowly
    const double patience = r.optical_depth < 0.3 ? 40.0 : 12.0;
    const Means means =
        equilibrium(r.optical_depth, 5e-3, r.restitution, r.dispersion.x(), 1500, patience, 2.0 * patience);
    CHECK(means.dispersion.x() == doctest::Approx(r.dispersion.x()).epsilon(r.tolerance));
    CHECK(means.dispersion.y() == doctest::Approx(r.dispersion.y()).epsilon(r.tolerance));
    CHECK(means.dispersion.z() == doctest::Approx(r.dispersion.z()).epsilon(r.tolerance));
    CHECK(means.height == doctest::Approx(r.height).epsilon(r.tolerance));
    CHECK(means.collisional_viscosity == doctest::Approx(r.collisional_viscosity).epsilon(0.10));
  }
}

TEST_CASE("in the steady state collisions lose what the viscous stress gains: (9/4) nu Omega^2 per unit mass") {
  const Scene scene = spheres(0.5, 1500, 5e-3, half, 3, 2.1);
  Simulation simulation(scene, initial_patch(scene));
  settle_and_average(simulation, scene, 12.0, 1.0);
  const simulation::SimulationState first = simulation.state();
  double translational = 0.0;
  constexpr int samples = 600;
  for (int k = 0; k < samples; ++k) { // 15 orbits
    for (int s = 0; s < 5; ++s)
      simulation.advance();
    const Patch patch = simulation.patch();
    for (std::size_t i = 0; i < patch.size(); ++i)
      translational += patch.velocities[i].x() * (patch.velocities[i].y() + 1.5 * patch.positions[i].x());
  }
  const simulation::SimulationState& last = simulation.state();
  const double count = static_cast<double>(last.particles.size()), mass = count * last.particles.bodies[0].mass;
  const double time = static_cast<double>(last.step - first.step) * last.step_length;
  const double viscosity = 2.0 / 3.0 *
                           (translational / (count * samples) +
                            (last.collisions.momentum_flux - first.collisions.momentum_flux) / (mass * time));
  const double loss = (last.collisions.energy_lost - first.collisions.energy_lost) / (mass * time);
  CHECK(loss == doctest::Approx(2.25 * viscosity).epsilon(0.03)); // sampling of the translational part
}
