#include <keeler/bench/drift.hpp>

#include <keeler/bench/median.hpp>
#include <keeler/bench/pair_set.hpp>
#include <keeler/bench/states.hpp>
#include <keeler/bench/yardsticks.hpp>
#include <keeler/collision/finders.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/simulation/simulation.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr double least_call_seconds = 0.1; // of finder calls, for the time of one
constexpr int untimed_steps = 10;          // in which buffers grow and the first window passes
constexpr double least_steps = 20.0;       // in each repeat: more than a window
constexpr double most_orbits = 0.1;        // in each repeat, beyond that many steps
constexpr double enough_passes = 4e6;      // particles × steps in each repeat

int timed_steps(double count, double step_orbits) {
  const double most = std::max(least_steps, most_orbits / step_orbits);
  return static_cast<int>(std::lround(std::clamp(enough_passes / count, least_steps, most)));
}

void time_calls(const DriftBenchSettings& settings, const Scene& scene, const SimulationState& state,
                DriftBench& bench) {
  const PairSet pairs = PairSet::of(state.particles, state.box, state.epoch_offset(), scene.collisions,
                                    scene.planet.frequencies, state.step_length, settings.all_pairs);
  const std::unique_ptr<Finder> finder = make_finder(scene.collisions.finder);
  std::vector<double> times;
  for (int repeat = 0; repeat < settings.repeats; ++repeat)
    times.push_back(ns_per_call(pairs, *finder, least_call_seconds));
  bench.ns_per_call = median(times);
  bench.calls_per_particle_step = static_cast<double>(pairs.queries.size()) / static_cast<double>(bench.count);
}

// All clocks and counts of a run, as they stand.
struct Reading {
  double seconds = bench_seconds();
  double advance;
  CollisionTally tally;
  DriftCosts costs;

  explicit Reading(Simulation& simulation)
      : advance(simulation.time_split().advance), tally(simulation.state().collisions),
        costs(simulation.drift().costs()) {}
  std::uint64_t contacts() const { return tally.fast + tally.slow; }
};

// The times of each repeat.
struct Times {
  std::vector<double> whole, advance, build, reject, solve, events, line, pair;

  void add(const Reading& before, const Reading& after, double passes) {
    const double ns = 1e9 / passes;
    whole.push_back(ns * (after.seconds - before.seconds));
    advance.push_back(ns * (after.advance - before.advance));
    build.push_back(ns * (after.costs.build - before.costs.build));
    reject.push_back(ns * (after.costs.reject - before.costs.reject));
    solve.push_back(ns * (after.costs.solve - before.costs.solve));
    events.push_back(ns * (after.costs.events - before.costs.events));
  }
};

// What some steps took, by the wall.
struct Lap {
  double seconds = 0.0, events = 0.0;
};

Lap run(Simulation& simulation, int steps) {
  Lap lap;
  const double before = simulation.drift().costs().events;
  {
    const Stopwatch stopwatch(lap.seconds);
    for (int k = 0; k < steps; ++k)
      simulation.advance();
  }
  lap.events = simulation.drift().costs().events - before;
  return lap;
}

// What several threads gain over one, lap by lap of the same run.
struct Gains {
  std::vector<double> step, events, pair;

  void compare(Simulation& simulation, const Lap& several, double pair_ns, int steps) {
    const int count = threads();
    set_threads(1);
    const Lap one = run(simulation, steps);
    step.push_back(one.seconds / several.seconds);
    events.push_back(one.events / several.events);
    pair.push_back(pair_yardstick(wall_seconds) / pair_ns);
    set_threads(count);
  }
};

void take_times(const Times& times, DriftBench& bench) {
  bench.ns_per_particle_step = median(times.whole);
  bench.split = {median(times.advance), median(times.build), median(times.reject), median(times.solve),
                 median(times.events)};
  bench.yardsticks = {median(times.line), median(times.pair)};
}

// Adds what happened between two readings; the numbers for each pass are sums until they are divided.
void add_counts(const Reading& before, const Reading& after, DriftBench& bench) {
  const auto more = [](std::uint64_t was, std::uint64_t is) { return static_cast<double>(is - was); };
  bench.pairs_per_particle += more(before.costs.pairs_tested, after.costs.pairs_tested);
  bench.survivors_per_particle += more(before.costs.survivors, after.costs.survivors);
  bench.collisions_per_particle_orbit += 2.0 * more(before.tally.fast, after.tally.fast);
  bench.contacts += after.contacts() - before.contacts();
  bench.recontacts += after.costs.recontacts - before.costs.recontacts;
  bench.conflicts += after.costs.conflicts - before.costs.conflicts;
  bench.repairs += after.costs.repairs - before.costs.repairs;
  bench.windows += after.costs.windows - before.costs.windows;
  bench.widest_list = after.costs.widest_list;
  bench.bytes_per_particle = after.costs.bytes_per_particle;
}

void divide_counts(double passes, double step_orbits, DriftBench& bench) {
  bench.pairs_per_particle /= passes;
  bench.survivors_per_particle /= passes;
  bench.collisions_per_particle_orbit /= passes * step_orbits;
  if (bench.contacts == 0)
    return;
  const double passes_per_contact = passes / static_cast<double>(bench.contacts);
  bench.ns_per_collision = bench.ns_per_particle_step * passes_per_contact;
  bench.ns_events_per_collision = bench.split.events * passes_per_contact;
}

} // namespace

DriftBench bench_drift(const DriftBenchSettings& settings) {
  PhaseProgress progress(settings.progress);
  BenchState made = bench_state(settings, progress);
  DriftBench bench;
  bench.count = made.patch.size();
  bench.steps = timed_steps(static_cast<double>(bench.count), settings.step_orbits);
  bench.dispersion_r_omega = velocity_in_radii(made.patch, velocity_dispersion(made.patch)).x();

  Simulation simulation(made.scene, made.patch);
  made.patch = {}; // room: a large state is held once
  time_calls(settings, made.scene, simulation.state(), bench);
  simulation.drift().every_candidate = settings.all_pairs;
  const double passes = static_cast<double>(bench.count) * bench.steps;
  progress.begin("timing", settings.repeats);
  run(simulation, untimed_steps);
  MemoryYardstick memory(bench.count);
  Times times;
  Gains gains;
  for (int repeat = 0; repeat < settings.repeats; ++repeat) {
    times.line.push_back(memory.measure());
    times.pair.push_back(pair_yardstick());
    const Reading before(simulation);
    const Lap lap = run(simulation, bench.steps);
    const Reading after(simulation);
    times.add(before, after, passes);
    add_counts(before, after, bench);
    if (threads() > 1)
      gains.compare(simulation, lap, times.pair.back(), bench.steps);
    progress.add(1.0);
  }
  take_times(times, bench);
  if (threads() > 1)
    bench.speedup = {median(gains.step), median(gains.events), median(gains.pair)};
  divide_counts(passes * settings.repeats, settings.step_orbits, bench);
  return bench;
}

} // namespace keeler
