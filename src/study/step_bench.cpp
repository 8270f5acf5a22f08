#include <keeler/study/step_bench.hpp>

#include "gravity_states.hpp"
#include <keeler/study/yardsticks.hpp>

#include <keeler/simulation/simulation.hpp>
#include <keeler/study/median.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr double untimed_steps = 10.0;                 // in which buffers grow and the first window passes
constexpr double least_steps = 20.0, most_steps = 100; // in each repeat
constexpr double enough_passes = 4e6;                  // particles × steps in each repeat

int whole_intervals(double steps, int kick_every) {
  return static_cast<int>(std::ceil(steps / kick_every)) * kick_every;
}

// The times of each repeat, ns per particle and step.
struct Times {
  std::vector<double> whole, drift, advance, gravity, kick;

  void add(double seconds, const TimeSplit& before, const TimeSplit& after, double passes) {
    const double ns = 1e9 / passes;
    const double moved = after.advance - before.advance, kicked = after.kick - before.kick;
    whole.push_back(ns * seconds);
    drift.push_back(ns * (after.drift - before.drift - moved));
    advance.push_back(ns * moved);
    gravity.push_back(ns * (after.gravity - before.gravity - kicked));
    kick.push_back(ns * kicked);
  }
};

void advance(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k)
    simulation.advance();
}

} // namespace

StepBench bench_step(const StepBenchSettings& settings) {
  PhaseProgress progress(settings.progress);
  BenchState made = gravity_state(settings.count, GravityState::clumped, progress);
  StepBench bench;
  bench.choice = default_gravity_choice(settings.solver);
  bench.choice.settings.kick_every = settings.kick_every;
  made.scene.gravity = bench.choice.settings;
  bench.count = made.patch.size();
  bench.step_orbits = made.scene.time.step;
  const auto count = static_cast<double>(bench.count);
  bench.steps = whole_intervals(std::clamp(enough_passes / count, least_steps, most_steps), settings.kick_every);

  Simulation simulation(made.scene, made.patch);
  made.patch = {}; // room: a large state is held once
  const double passes = count * bench.steps;
  progress.begin("timing", settings.repeats);
  advance(simulation, whole_intervals(untimed_steps, settings.kick_every));
  const std::uint64_t first = simulation.state().collisions.fast;
  Times times;
  for (int repeat = 0; repeat < settings.repeats; ++repeat) {
    const double start = bench_seconds();
    const TimeSplit before = simulation.time_split();
    advance(simulation, bench.steps);
    times.add(bench_seconds() - start, before, simulation.time_split(), passes);
    progress.add(1.0);
  }
  bench.ns_per_particle_step = median(times.whole);
  bench.split = {median(times.drift), median(times.advance), median(times.gravity), median(times.kick)};
  bench.collisions_per_particle_step =
      2.0 * static_cast<double>(simulation.state().collisions.fast - first) / (passes * settings.repeats);
  return bench;
}

} // namespace keeler
