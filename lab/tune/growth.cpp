#include "growth.hpp"

#include <keeler/bench/yardsticks.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/simulation/simulation.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::tune {
namespace {

constexpr double growth_force_error = 1e-2;
constexpr int instants = 3; // probed states of the last orbit, or of the last half of a shorter evolution

// Returns the scene's physics with cheap numerical settings, to evolve the state.
Scene coarse(Scene scene) {
  scene.time.automatic = true;
  scene.time.step = 1.0 / scene::TimeSettings::ticks_per_orbit;
  if (scene.gravity) {
    scene.gravity->kick_every = 1;
    if (scene.gravity->images.far) {
      scene.gravity->solver = GravitySettings::Solver::automatic;
      scene.gravity->force_error = growth_force_error;
    }
  }
  return scene;
}

std::uint64_t contacts_of(const Simulation& simulation) {
  return simulation.state().collisions.fast + simulation.state().collisions.slow;
}

// Advances to a time, and on to the next tick at which the longest steps end: there both halves of the kicks are
// applied.
void run_until(Simulation& simulation, double orbits, PhaseProgress& progress) {
  while (simulation.orbits() < orbits || simulation.state().step % scene::TimeSettings::longest != 0) {
    const double before = simulation.orbits();
    simulation.advance();
    progress.add(simulation.orbits() - before);
  }
}

} // namespace

GrownScene grow(const Scene& scene, double orbits, PhaseProgress& progress) {
  assert(orbits > 0.0);
  progress.begin("evolving the probed state", orbits);
  const Patch start = initial_patch(scene);
  GrownScene growth;
  growth.scene = decided_by(scene, initial_conditions::scale_of(start));
  Simulation simulation(coarse(growth.scene), start);
  const double last = std::min(1.0, 0.5 * orbits), begin = bench::bench_seconds();
  double begin_last = begin, from = 0.0;
  std::uint64_t contacts = 0;
  for (int k = 0; k < instants; ++k) {
    run_until(simulation, orbits - last * (instants - 1 - k) / (instants - 1), progress);
    growth.states.push_back(simulation.patch());
    if (k > 0)
      continue;
    begin_last = bench::bench_seconds();
    from = simulation.orbits();
    contacts = contacts_of(simulation);
  }
  growth.orbits = simulation.orbits();
  const double time = growth.orbits - from,
               particles = static_cast<double>(std::max<std::size_t>(1, growth.states.back().size()));
  growth.contact_rate = 2.0 * static_cast<double>(contacts_of(simulation) - contacts) / (particles * time);
  growth.seconds = bench::bench_seconds() - begin;
  growth.seconds_at_end = (bench::bench_seconds() - begin_last) / time;
  return growth;
}

} // namespace keeler::tune
