#include "growth.hpp"

#include <keeler/bench/yardsticks.hpp>
#include <keeler/simulation/simulation.hpp>
#include <keeler/states/initial.hpp>

#include <algorithm>

namespace keeler {
namespace {

constexpr double force_error = 1e-2;

// The same physics, to get somewhere.
Scene coarse(Scene scene) {
  scene.time.automatic = true;
  scene.time.step = 1.0 / TimeSettings::ticks_per_orbit;
  if (scene.gravity) {
    scene.gravity->kick_every = 1;
    if (scene.gravity->images.far) {
      scene.gravity->solver = GravitySettings::Solver::automatic;
      scene.gravity->force_error = force_error;
    }
  }
  return scene;
}

std::uint64_t contacts_of(const Simulation& simulation) {
  return simulation.state().collisions.fast + simulation.state().collisions.slow;
}

} // namespace

Growth grow(const Scene& scene, double orbits, PhaseProgress& progress) {
  progress.begin("the state that is probed", orbits);
  Simulation simulation(coarse(scene), initial_patch(scene));
  Growth growth;
  const double last = std::max(0.0, orbits - 1.0), begin = bench_seconds();
  double begin_last = begin, from = 0.0;
  std::uint64_t contacts = 0;
  // to a tick where the longest steps end: there the state stands with both halves of its kicks
  while (simulation.orbits() < orbits || simulation.state().step % TimeSettings::longest != 0) {
    if (simulation.orbits() <= last) {
      begin_last = bench_seconds();
      from = simulation.orbits();
      contacts = contacts_of(simulation);
    }
    const double before = simulation.orbits();
    simulation.advance();
    progress.add(simulation.orbits() - before);
  }
  growth.patch = simulation.patch();
  growth.orbits = simulation.orbits();
  const double time = growth.orbits - from,
               particles = static_cast<double>(std::max<std::size_t>(1, growth.patch.size()));
  growth.contact_rate = 2.0 * static_cast<double>(contacts_of(simulation) - contacts) / (particles * time);
  growth.seconds = bench_seconds() - begin;
  growth.seconds_at_end = (bench_seconds() - begin_last) / time;
  return growth;
}

} // namespace keeler
