#include "probes.hpp"

#include <keeler/bench/median.hpp>
#include <keeler/bench/yardsticks.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/simulation/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace keeler {
namespace {

constexpr double settling = 0.05, counting = 0.25; // orbits of a probe of kicks
constexpr double untimed = 0.02, timed = 0.03;     // at least, of each lap of a probe of steps
constexpr double enough_seconds = 0.15;            // of a lap
constexpr int laps = 3;

std::uint64_t contacts_of(const CollisionTally& tally) {
  return tally.fast + tally.slow;
}

// Whole kick intervals.
void run(Simulation& simulation, double orbits, int drifts) {
  constexpr double rounding = 1e-9;
  const double end = simulation.orbits() + orbits - rounding;
  do
    for (int k = 0; k < drifts; ++k)
      simulation.advance();
  while (simulation.orbits() < end);
}

// One candidate, which goes on from lap to lap.
struct Candidate {
  StepProbe probe;
  std::unique_ptr<Simulation> simulation;
  std::vector<double> seconds; // an orbit
  std::uint64_t contacts = 0;
  double orbits = 0.0;

  void measure() {
    const CollisionTally before = simulation->state().collisions;
    const double start = bench_seconds(), from = simulation->orbits();
    do
      run(*simulation, timed, probe.drifts);
    while (bench_seconds() - start < enough_seconds);
    const double passed = simulation->orbits() - from;
    seconds.push_back((bench_seconds() - start) / passed);
    contacts += contacts_of(simulation->state().collisions) - contacts_of(before);
    orbits += passed;
  }

  StepProbe result() const {
    StepProbe done = probe;
    done.seconds = median(seconds);
    const double particles = static_cast<double>(std::max<std::size_t>(1, simulation->state().particles.size()));
    done.contacts = 2.0 * static_cast<double>(contacts) * probe.step / (particles * orbits);
    return done;
  }
};

} // namespace

Scene with_steps(Scene scene, double step, int drifts) {
  scene.time.automatic = false;
  scene.time.step = step;
  if (scene.gravity)
    scene.gravity->kick_every = drifts;
  return scene;
}

KickProbe probe_kicks(const Scene& scene, const Patch& patch, double interval, int drifts) {
  Simulation simulation(with_steps(scene, interval / drifts, drifts), patch);
  run(simulation, settling, drifts);
  const CollisionTally before = simulation.state().collisions;
  run(simulation, counting, drifts);
  const CollisionTally after = simulation.state().collisions;
  const auto contacts = static_cast<double>(contacts_of(after) - contacts_of(before));
  return {interval, static_cast<double>(after.unresolved - before.unresolved) / std::max(1.0, contacts)};
}

std::vector<StepProbe> probe_steps(const Scene& scene, const Patch& patch, double interval,
                                   const std::vector<int>& drifts, PhaseProgress& progress) {
  progress.begin("steps", static_cast<double>(drifts.size()) * (laps + 1));
  std::vector<Candidate> candidates;
  for (const int count : drifts) {
    Candidate& added = candidates.emplace_back();
    added.probe = {interval / count, count};
    added.simulation = std::make_unique<Simulation>(with_steps(scene, interval / count, count), patch);
    run(*added.simulation, untimed, count);
    progress.add(1.0);
  }
  for (int lap = 0; lap < laps; ++lap)
    for (Candidate& candidate : candidates) {
      candidate.measure();
      progress.add(1.0);
    }
  std::vector<StepProbe> probes;
  for (const Candidate& candidate : candidates)
    probes.push_back(candidate.result());
  return probes;
}

std::vector<ThreadProbe> probe_threads(const Scene& scene, const Patch& patch, int most, PhaseProgress& progress) {
  std::vector<int> counts = {1};
  for (int count = 2; count < most; count *= 2)
    counts.push_back(count);
  if (most > 1)
    counts.push_back(most);
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
      const double start = wall_seconds(), from = simulation.orbits();
      do
        run(simulation, timed, drifts);
      while (wall_seconds() - start < enough_seconds);
      const double seconds = (wall_seconds() - start) / (simulation.orbits() - from);
      one = k == 0 ? seconds : one;
      gains[k].push_back(one / seconds);
      progress.add(1.0);
    }
  }
  set_threads(before);
  std::vector<ThreadProbe> probes;
  for (std::size_t k = 0; k < counts.size(); ++k)
    probes.push_back({counts[k], median(gains[k])});
  return probes;
}

} // namespace keeler
