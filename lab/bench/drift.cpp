#include <keeler/bench/drift.hpp>

#include "states.hpp"

#include <keeler/bench/pair_set.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/simulation/simulation.hpp>
#include <keeler/statistics/median.hpp>

#include <cassert>
#include <cmath>

namespace keeler::bench {
namespace {

constexpr double min_call_seconds = 0.1; // of calls that one measurement of the time per call averages over
constexpr double max_orbits = 0.1;       // per repeat

void time_calls(const DriftBenchSettings& settings, const Scene& scene, const simulation::SimulationState& state,
                DriftBench& bench) {
  const PairSet pairs = PairSet::of(state.particles, state.box, state.epoch_offset(), scene.collisions,
                                    scene.planet.frequencies, state.step_length, settings.all_pairs);
  const std::unique_ptr<finders::Finder> finder = finders::make_finder(scene.collisions.finder);
  std::vector<double> times;
  for (int repeat = 0; repeat < settings.repeats; ++repeat)
    times.push_back(ns_per_call(pairs, *finder, min_call_seconds));
  bench.ns_per_call = statistics::median(times);
  bench.calls_per_particle_step =
      static_cast<double>(pairs.queries.size()) / static_cast<double>(state.particles.size());
}

// Makes the drift pass every candidate pair to the finder.
struct Everything final : collision::DriftObserver {
  bool wants_every_candidate() const override { return true; }
  bool wants_events() const override { return false; }
};

} // namespace

DriftBench bench_drift(const DriftBenchSettings& settings) {
  assert(settings.repeats > 0 && settings.step_orbits > 0.0);
  PhaseProgress progress(settings.progress);
  BenchState made = bench_state(settings, progress);
  DriftBench bench;
  bench.dispersion_r_omega =
      diagnostics::velocity_in_radii(made.patch, diagnostics::velocity_dispersion(made.patch)).x();
  const double steps = steps_worth_timing(made.patch.size(), settings.step_orbits, max_orbits / settings.step_orbits);

  Simulation simulation(made.scene, made.patch);
  made.patch = {}; // frees memory: a large state is stored once
  time_calls(settings, made.scene, simulation.state(), bench);
  Everything everything;
  simulation.drift().observe(settings.all_pairs ? &everything : nullptr);
  bench.timed = time_steps(simulation, static_cast<int>(std::lround(steps)), settings.repeats, 1, progress);
  return bench;
}

} // namespace keeler::bench
