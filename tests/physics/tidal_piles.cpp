// A pile of spheres at rest under its own gravity in the planet's tide: it rests where gravity holds it, and is torn
// where tides pull harder. On the radial line through its centre tides pull by 3 Ω² R and a spherical pile of filling φ
// by 4/3 π G ρ φ R, which is 12 φ r_h³ Ω² R: equal at r_h = (4 φ)^(−1/3), 0.79 for φ = 0.5. Smooth spheres roll off
// each other, so a pile flows, grows long, and must be denser than that: aggregates last from r_h 1.1 to 1.2 on (Salo
// 1995; Karjalainen & Salo 2004).
#include "scenes.hpp"

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/clusters.hpp>
#include <keeler/scene/load.hpp>

#include <Eigen/Dense>
#include <doctest/doctest.h>

using namespace keeler;

namespace {

constexpr int count = 300;

Scene scene_of(double hill_parameter) { // r_h = 0.82 (ρ/900)^(1/3) (a/10⁸), a = 140,221 km
  const double density = 900.0 * std::pow(hill_parameter / (0.82 * 1.40221), 3);
  return parse_scene(
      fmt::format("planet.preset = \"saturn-f-ring\"\nbox.size = [100, 120]\ntime = {{ step = 2e-3, end = 1.5 }}\n"
                  "gravity = {{ solver = \"direct\", kick_every = 2, resting_contacts = \"carried\" }}\n"
                  "collisions.restitution = {{ law = \"constant\", value = 0.5 }}\n"
                  "[particles]\ncount = {}\ndensity = {}\nseed = 1\nsizes = {{ law = \"equal\", radius = 1.0 }}\n"
                  "[[particles.aggregate]]\ncount = {}\nposition = [0, 0, 0]\nfilling_factor = 0.5\n",
                  count, density, count),
      "test scene");
}

// J: of all pairs.
double binding_energy(const Patch& patch) {
  const double rate = patch.orbital_frequency;
  double sum = 0.0; // kg² / m
  for (std::size_t i = 0; i < patch.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      sum += patch.masses[i] * patch.masses[j] / (patch.positions[i] - patch.positions[j]).norm();
  return newton_g(rate) * rate * rate * sum;
}

// rΩ, for r = 1 m: the mean square speed beyond the motion and rotation of the whole as one body.
double internal_speed(const Patch& patch) {
  Vec3 centre = Vec3::Zero(), drift = Vec3::Zero(), turn = Vec3::Zero();
  const double share = 1.0 / static_cast<double>(patch.size());
  for (std::size_t k = 0; k < patch.size(); ++k) {
    centre += share * patch.positions[k];
    drift += share * patch.velocities[k];
  }
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3 place = patch.positions[k] - centre;
    inertia += place.squaredNorm() * Eigen::Matrix3d::Identity() - place * place.transpose();
    turn += place.cross(patch.velocities[k] - drift);
  }
  const Vec3 rotation = inertia.ldlt().solve(turn);
  double squares = 0.0;
  for (std::size_t k = 0; k < patch.size(); ++k)
    squares += (patch.velocities[k] - drift - rotation.cross(patch.positions[k] - centre)).squaredNorm();
  return std::sqrt(share * squares);
}

struct Pile {
  double share = 0.0; ///< of all mass, in the largest cluster
  double speed = 0.0; ///< rΩ
  double lost = 0.0;  ///< of the binding energy an orbit, over the last half orbit
  std::size_t pairs_at_rest = 0;
};

Pile after_an_orbit_and_a_half(double hill_parameter) {
  const Scene scene = scene_of(hill_parameter);
  Simulation simulation(scene, initial_patch(scene));
  const auto run_until = [&](double orbits) {
    while (simulation.orbits() < orbits - 1e-12)
      simulation.advance();
    return simulation.state().collisions.energy_lost;
  };
  const double before = run_until(1.0), lost = run_until(1.5) - before;
  const Patch patch = simulation.patch();
  const double rate = patch.orbital_frequency;
  return {diagnostics::analyze_clusters(std::span(&patch, 1), 0.2).largest_mass_fraction, internal_speed(patch),
          2.0 * rate * rate * lost / binding_energy(patch), simulation.state().resting.pairs.size()};
}

} // namespace

TEST_CASE("a pile rests at r_h 1.25, and tides tear it at 0.7 and 1.0") {
  for (const double r_h : {0.7, 1.0}) {
    const Pile torn = after_an_orbit_and_a_half(r_h);
    MESSAGE("r_h " << r_h << ": largest share " << torn.share);
    CHECK(torn.share < 0.5);
  }
  const Pile held = after_an_orbit_and_a_half(1.25);
  MESSAGE("r_h 1.25: share " << held.share << ", speed " << held.speed << " rΩ, lost " << held.lost
                             << " of the binding energy an orbit, pairs at rest " << held.pairs_at_rest);
  CHECK(held.share == 1.0);
  CHECK(held.pairs_at_rest > 2 * count); // more than hold it up at random places
  CHECK(held.speed < 0.05);              // 0.9 where contacts bounce
  CHECK(held.lost < 0.01);
}
