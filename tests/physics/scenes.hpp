// Scenes of the physics tests, and means over a run of them.
#pragma once

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::test {

/// Ω of the reference runs: r Ω = 0.0195 cm/s for r = 1 m (it matters to the Bridges law alone).
inline constexpr double reference_omega = 1.95e-4;

/// Equal spheres of 1 m without self-gravity in a square box, κ = ν = Ω, as in the reference runs.
inline Scene spheres(double optical_depth, int count, double step, const std::string& restitution, std::uint64_t seed,
                     double dispersion = 2.0) {
  const double side = std::sqrt(3.14159265358979 * count / optical_depth);
  return parse_scene(fmt::format(R"(
[planet]
orbital_frequency = {}
[box]
size = [{}, {}]
[particles]
count = {}
density = 900.0
sizes = {{ law = "equal", radius = 1.0 }}
velocity_dispersion = {}
seed = {}
[collisions]
restitution = {}
[time]
step = {}
end = 100.0
)",
                                 reference_omega, side, side, count, dispersion, seed, restitution, step),
                     "test scene");
}

/// Time means of a run, taken ten times an orbit.
struct Means {
  Vec3 dispersion = Vec3::Zero();     ///< r Ω for r = 1 m
  double height = 0.0;                ///< m
  double fast = 0.0, slow = 0.0;      ///< collisions per particle and orbit
  double collisional_viscosity = 0.0; ///< r² Ω
};

/// Lets a simulation settle for some orbits and averages over some more.
inline Means settle_and_average(Simulation& simulation, const Scene& scene, double settle, double average) {
  const auto steps = [&](double orbits) { return std::lround(orbits / scene.time.step); };
  for (long k = 0; k < steps(settle); ++k)
    simulation.advance();
  const CollisionTally before = simulation.state().collisions;
  Means means;
  const long total = steps(average), every = std::max(1L, steps(0.1));
  for (long k = 1; k <= total; ++k) {
    simulation.advance();
    if (k % every != 0)
      continue;
    const Patch patch = simulation.patch();
    means.dispersion +=
        diagnostics::velocity_dispersion(patch) * static_cast<double>(every) / static_cast<double>(total);
    means.height += diagnostics::scale_height(patch) * static_cast<double>(every) / static_cast<double>(total);
  }
  const CollisionTally& after = simulation.state().collisions;
  const double count = static_cast<double>(simulation.state().particles.size());
  means.fast = 2.0 * static_cast<double>(after.fast - before.fast) / count / average;
  means.slow = 2.0 * static_cast<double>(after.slow - before.slow) / count / average;
  double mass = 0.0;
  for (const Body& body : simulation.state().particles.bodies)
    mass += body.mass;
  const double time = average * 2.0 * 3.14159265358979;
  means.collisional_viscosity = 2.0 / 3.0 * (after.momentum_flux - before.momentum_flux) / (mass * time);
  return means;
}

} // namespace keeler::test
