// Two spheres that fall on each other along z: how far the speed of their rebound is off when gravity acts in kicks.
//
// Between two kicks the spheres approach at the exact speed of the middle of the interval. A contact at a time δ after
// that middle comes g δ too slowly, g the relative acceleration there. A rebound from that speed errs by (1 + ε) g δ:
// ε g δ is left after the bounce, and the kick that ends the interval takes g h/2 where gravity had only h/2 − δ to
// act. Over contacts at any time of the interval that has the rms (1 + ε) g h/√12. Contacts with the speed of their own
// time err by h² only, as their place does (src/collision/contact_law.hpp).
#pragma once

#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::test {

/// Of speeds at the instant of the rebound, in r Ω for r = 1 m.
struct ReboundErrors {
  double rms = 0.0, mean = 0.0;
  double of_drift = 0.0; ///< (1 + ε) g h/√12: the rms of rebounds from the speed of the drift
};

/// Of pairs of spheres of 1 m and 900 kg/m³ that start at rest, 3 to 4 m apart. `kick_interval` is in orbits, of
/// `kick_every` steps. The speed of the rebound follows from the energy of the pair when its kick interval is over.
inline ReboundErrors rebound_errors(int pairs, double kick_interval, double restitution, int kick_every = 1) {
  constexpr double omega = 1.3175e-4, contact = 2.0, mass = 4.0 / 3.0 * pi * 900.0;
  const double attraction = 2.0 * newton_g(omega) * mass;
  const auto potential = [&](double distance) { return 0.5 * distance * distance - attraction / distance; };
  const Scene scene = parse_scene(fmt::format(R"(
planet.orbital_frequency = {}
box.size = [100.0, 100.0]
particles = {{ count = 2, density = 900.0, sizes = {{ law = "equal", radius = 1.0 }} }}
collisions.restitution = {{ law = "constant", value = {} }}
gravity = {{ solver = "direct", images = "rings", image_rings = 0, kick_every = {} }}
time = {{ step = {:.17g}, end = 10.0 }}
)",
                                              omega, restitution, kick_every, kick_interval / kick_every),
                                  "two spheres");
  ReboundErrors errors;
  errors.of_drift = (1.0 + restitution) * attraction / (contact * contact) * two_pi * kick_interval / std::sqrt(12.0);
  const int threads_before = threads();
  set_threads(1); // two particles
  for (int k = 0; k < pairs; ++k) {
    // the golden ratio spreads the contacts evenly over the phases of the interval
    const double distance = 3.0 + std::fmod(0.6180339887498949 * (k + 1), 1.0);
    Patch start;
    start.box = {100.0, 100.0, 1.5, 0.0};
    start.orbital_frequency = omega;
    start.positions = {{0.0, 0.0, -0.5 * distance}, {0.0, 0.0, 0.5 * distance}};
    start.velocities.assign(2, Vec3::Zero());
    start.radii.assign(2, 1.0);
    start.masses.assign(2, mass);
    start.ids = {0, 1};
    Simulation simulation(scene, start);
    int steps = 0;
    while (simulation.state().collisions.fast == 0 || steps % kick_every != 0) {
      simulation.advance();
      ++steps;
    }
    const Patch end = simulation.patch();
    const double speed = end.velocities[1].z() - end.velocities[0].z(),
                 now = end.positions[1].z() - end.positions[0].z();
    const double rebound = std::sqrt(speed * speed + 2.0 * (potential(now) - potential(contact)));
    const double error = rebound - restitution * std::sqrt(2.0 * (potential(distance) - potential(contact)));
    errors.mean += error / pairs;
    errors.rms += error * error / pairs;
  }
  set_threads(threads_before);
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

} // namespace keeler::test
