#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace radial_gravity_test {

using namespace keeler;

// The axisymmetric waves of a cold thin disc have ω² = κ² − 2π G Σ |k| (Toomre 1964; Binney & Tremaine 2008, eq. 6.52).
// Particles keep X, so a displacement A sin kX with no radial velocity oscillates as A sin kX cos ωt while kA is small.
TEST_CASE("waves of a cold ring in its radial self-gravity swing at Toomre's frequency") {
  constexpr std::size_t count = 400;
  constexpr double length = 1000.0, amplitude = 1.0, fraction = 0.4; // reduction of κ² by gravity
  constexpr int waves = 2;
  const Scene scene = parse_scene("planet = { orbital_frequency = 2e-4, epicyclic_ratio = 0.95 }\n"
                                  "box.size = [1000.0, 1000.0]\n"
                                  "particles = { count = 400, density = 900.0, sizes = { law = \"equal\", radius = "
                                  "0.01 } }\ntime = { step = 2e-3, end = 2.0 }\n"
                                  "[gravity]\nsolver = \"axisymmetric\"\nshortest_wavelength = 100\n",
                                  "test scene");
  const Frequencies& f = scene.planet.frequencies;
  const double k = two_pi * waves / length, kappa2 = f.kappa * f.kappa;
  const double density = fraction * kappa2 / (two_pi * newton_g(scene.planet.orbital_frequency) * k);
  Patch patch;
  patch.box = {length, length, f.shear(), 0.0};
  patch.frequencies = f;
  patch.orbital_frequency = scene.planet.orbital_frequency;
  for (std::size_t p = 0; p < count; ++p) {
    const double x = (static_cast<double>(p) + 0.5) / count * length - 0.5 * length;
    const double e = -amplitude * std::sin(k * x);
    patch.positions.emplace_back(x - e, std::fmod(37.0 * static_cast<double>(p), length) - 0.5 * length, 0.0);
    patch.velocities.emplace_back(0.0, 2.0 * e - f.shear() * x, 0.0);
    patch.radii.push_back(0.01);
    patch.masses.push_back(density * length * length / count);
    patch.ids.push_back(p);
  }
  Simulation simulation(scene, patch);
  const double omega = f.kappa * std::sqrt(1.0 - fraction);
  double largest = 0.0;
  while (simulation.orbits() < 2.0 - 1e-9) {
    simulation.advance();
    const Patch now = simulation.patch();
    double projection = 0.0; // of the displacement on sin kX
    for (std::size_t p = 0; p < count; ++p) {
      const double x = (static_cast<double>(p) + 0.5) / count * length - 0.5 * length;
      projection += 2.0 / count * (now.positions[p].x() - x) * std::sin(k * x);
    }
    largest = std::max(largest, std::fabs(projection / amplitude - std::cos(omega * two_pi * simulation.orbits())));
  }
  CHECK(largest < 1e-3); // k A is 0.013: its square is 1.6e-4
  CHECK(simulation.state().collisions.fast + simulation.state().collisions.slow == 0);
}

} // namespace radial_gravity_test
