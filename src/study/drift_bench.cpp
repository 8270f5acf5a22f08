#include <keeler/study/drift_bench.hpp>

#include <keeler/collision/finders.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/scene/derived.hpp>
#include <keeler/simulation/simulation.hpp>
#include <keeler/states/initial.hpp>
#include <keeler/study/median.hpp>
#include <keeler/study/pair_set.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace keeler {
namespace {

constexpr double least_seconds = 0.1; // of finder calls, for the time of one

// Near c_x of the equilibrium at ε = 0.5, in rΩ: 2.82, 2.18 and 1.62 at τ = 0.1, 0.5 and 1; more where particles of
// that dispersion could not be placed.
double first_dispersion(double optical_depth) {
  const double placed = 1.001 * dispersion_for_filling(optical_depth, {}, 1.0, largest_filling);
  return std::max(3.0 * std::exp(-0.62 * optical_depth), placed);
}

Scene bench_scene(const DriftBenchSettings& s) {
  const double size = std::sqrt(pi * static_cast<double>(s.count) / s.optical_depth);
  return parse_scene(fmt::format(R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [{0}, {0}]
[particles]
count = {1}
density = 900.0
velocity_dispersion = {2}
sizes = {{ law = "equal", radius = 1.0 }}
[collisions]
finder = "{3}"
restitution = {{ law = "constant", value = 0.5 }}
[time]
step = {4}
end = {4}
)",
                                 size, s.count, first_dispersion(s.optical_depth), s.finder, s.step_orbits),
                     "bench");
}

Patch equilibrium(Scene scene) {
  constexpr int steps = 150;
  scene.collisions.finder = "certified";
  scene.time.step = 1.5 / steps;
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < steps; ++k)
    simulation.advance();
  return simulation.patch();
}

double clock_now() {
  static const auto start = std::chrono::steady_clock::now();
  return threads() == 1 ? cpu_seconds()
                        : std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double finder_time(const Scene& scene, const SimulationState& state, bool all_pairs, double& calls) {
  const PairSet pairs = PairSet::of(state.particles, state.box, state.epoch_offset(), scene.collisions,
                                    scene.planet.frequencies, state.step_length, all_pairs);
  calls = static_cast<double>(pairs.queries.size()) / static_cast<double>(state.particles.size());
  return ns_per_call(pairs, *make_finder(scene.collisions.finder), least_seconds);
}

} // namespace

DriftBench bench_drift(const DriftBenchSettings& settings) {
  const Scene scene = bench_scene(settings);
  const Patch start = equilibrium(scene);
  const double count = static_cast<double>(settings.count);
  DriftBench bench;
  bench.steps = static_cast<int>(std::clamp(std::round(2e6 / count), 3.0, std::max(3.0, 0.1 / settings.step_orbits)));
  bench.dispersion_r_omega = velocity_in_radii(start, velocity_dispersion(start)).x();

  std::vector<double> step_times, call_times;
  for (int repeat = 0; repeat < settings.repeats; ++repeat) {
    Simulation simulation(scene, start);
    simulation.drift().every_candidate = settings.all_pairs;
    call_times.push_back(finder_time(scene, simulation.state(), settings.all_pairs, bench.calls_per_particle_step));
    const double begin = clock_now();
    for (int k = 0; k < bench.steps; ++k)
      simulation.advance();
    step_times.push_back(1e9 * (clock_now() - begin) / (count * bench.steps));
    bench.collisions_per_particle_orbit =
        2.0 * static_cast<double>(simulation.state().collisions.fast) / (count * simulation.orbits());
  }
  bench.ns_per_particle_step = median(step_times);
  bench.ns_per_call = median(call_times);
  return bench;
}

} // namespace keeler
