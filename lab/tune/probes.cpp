#include "probes.hpp"

#include <keeler/bench/yardsticks.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/simulation/simulation.hpp>
#include <keeler/statistics/median.hpp>
#include <keeler/statistics/scatter.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::tune {
namespace {

constexpr double settling = 0.05, counting = 0.15; // orbits per state in a probe of kicks
constexpr std::uint64_t enough_contacts = 50000;   // per state: 1 % of them is 500, which scatters by 5 %
constexpr double untimed = 0.02, timed = 0.03;     // smallest orbits of a lap
constexpr double enough_seconds = 0.15;            // smallest duration of a lap
constexpr int laps = 3;                            // in a probe of threads

std::uint64_t contacts_of(const CollisionTally& tally) {
  return tally.fast + tally.slow;
}

// Advances by at least `orbits` in whole kick intervals of `drifts` steps.
void run(Simulation& simulation, double orbits, int drifts) {
  assert(drifts > 0);
  constexpr double rounding = 1e-9;
  const double end = simulation.orbits() + orbits - rounding;
  do
    for (int k = 0; k < drifts; ++k)
      simulation.advance();
  while (simulation.orbits() < end);
}

struct Lap {
  double seconds = 0.0; // per orbit
  double contacts = 0.0, orbits = 0.0;
};

Lap lap_of(const Scene& scene, const Patch& state, const StepProbe& probe) {
  Simulation simulation(with_steps(scene, probe.step, probe.drifts), state);
  run(simulation, untimed, probe.drifts);
  const std::uint64_t before = contacts_of(simulation.state().collisions);
  const double start = bench::bench_seconds(), from = simulation.orbits();
  do
    run(simulation, timed, probe.drifts);
  while (bench::bench_seconds() - start < enough_seconds);
  const double passed = simulation.orbits() - from;
  return {(bench::bench_seconds() - start) / passed,
          static_cast<double>(contacts_of(simulation.state().collisions) - before), passed};
}

} // namespace

Scene with_steps(Scene scene, double step, int drifts) {
  assert(step > 0.0 && drifts > 0);
  scene.time.automatic = false;
  scene.time.step = step;
  if (scene.gravity)
    scene.gravity->kick_every = drifts;
  return scene;
}

KickProbe probe_kicks(const Scene& scene, const std::vector<Patch>& states, double interval, int drifts,
                      double max_orbits) {
  assert(!states.empty());
  std::vector<double> unresolved;
  for (const Patch& state : states) {
    Simulation simulation(with_steps(scene, interval / drifts, drifts), state);
    run(simulation, settling, drifts);
    const CollisionTally before = simulation.state().collisions;
    const double from = simulation.orbits();
    do
      run(simulation, counting, drifts);
    while (contacts_of(simulation.state().collisions) - contacts_of(before) < enough_contacts &&
           simulation.orbits() - from < max_orbits);
    const CollisionTally after = simulation.state().collisions;
    const auto contacts = static_cast<double>(contacts_of(after) - contacts_of(before));
    unresolved.push_back(static_cast<double>(after.unresolved - before.unresolved) / std::max(1.0, contacts));
  }
  const statistics::Scatter scatter = statistics::scatter_of(unresolved);
  return {interval, scatter.mean, scatter.mean_error()};
}

std::vector<StepProbe> probe_steps(const Scene& scene, const std::vector<Patch>& states, double interval,
                                   const std::vector<int>& drifts, PhaseProgress& progress) {
  assert(!states.empty() && !drifts.empty());
  progress.begin("steps", static_cast<double>(drifts.size() * states.size()));
  std::vector<StepProbe> probes;
  for (const int count : drifts)
    probes.push_back({interval / count, count, 0.0, 0.0});
  const double particles = static_cast<double>(std::max<std::size_t>(1, states.back().size()));
  const double weight = 1.0 / static_cast<double>(states.size());
  for (const Patch& state : states)
    for (StepProbe& probe : probes) {
      const Lap lap = lap_of(scene, state, probe);
      probe.seconds += weight * lap.seconds;
      probe.contacts += weight * 2.0 * lap.contacts * probe.step / (particles * lap.orbits);
      progress.add(1.0);
    }
  return probes;
}

std::vector<ThreadProbe> probe_threads(const Scene& scene, const Patch& patch, int thread_limit,
                                       PhaseProgress& progress) {
  std::vector<int> counts = {1};
  for (int count = 2; count < thread_limit; count *= 2)
    counts.push_back(count);
  if (thread_limit > 1)
    counts.push_back(thread_limit);
  if (counts.size() == 1)
    return {ThreadProbe{}};
  const int before = threads();
  const int drifts = scene.gravity ? static_cast<int>(scene.gravity->kick_every) : 1;
  Simulation simulation(scene, patch);
  run(simulation, untimed, drifts);
  progress.begin("threads", static_cast<double>(laps * counts.size()));
  std::vector<std::vector<double>> gains(counts.size());
  for (int lap = 0; lap < laps; ++lap) {
    double one = 0.0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      set_threads(counts[k]);
      const double start = bench::wall_seconds(), from = simulation.orbits();
      do
        run(simulation, timed, drifts);
      while (bench::wall_seconds() - start < enough_seconds);
      const double seconds = (bench::wall_seconds() - start) / (simulation.orbits() - from);
      one = k == 0 ? seconds : one;
      gains[k].push_back(one / seconds);
      progress.add(1.0);
    }
  }
  set_threads(before);
  std::vector<ThreadProbe> probes;
  for (std::size_t k = 0; k < counts.size(); ++k)
    probes.push_back({counts[k], statistics::median(gains[k])});
  return probes;
}

} // namespace keeler::tune
