// Times the drift phase: spheres without gravity, in collisional equilibrium at ε = 0.5.
#pragma once

#include <keeler/bench/timed_steps.hpp>
#include <keeler/core/progress.hpp>

#include <cstddef>
#include <functional>
#include <string>

namespace keeler::bench {

enum class BenchSizes {
  equal,  ///< all 1 m
  power,  ///< n(r) dr ∝ r⁻³ from 1 m to 100 m
  moonlet ///< 1 m, with one sphere of 100 m
};

struct DriftBenchSettings {
  std::size_t count = 10000; ///< rounded to whole tiles in a large state, and to the space that a moonlet leaves
  double step_orbits = 1e-3;
  double optical_depth = 0.5; ///< with a moonlet: outside of it
  BenchSizes sizes = BenchSizes::equal;
  std::string finder = "certified";
  int repeats = 5;
  bool all_pairs = false;                        ///< pass every grid candidate to the finder
  std::function<void(const Progress&)> progress; ///< may be empty
};

struct DriftBench {
  TimedSteps timed;         ///< of steps with a drift only
  double ns_per_call = 0.0; ///< of the finder on one thread, on the pairs that the first step passes to it
  double calls_per_particle_step = 0.0;
  double dispersion_r_omega = 0.0; ///< c_x of the timed state, ⟨r⟩ Ω
};

/// Makes the state and times it. Precondition: count, step_orbits, optical_depth and repeats are positive.
/// Throws UsageError for an unknown finder or an impossible patch.
DriftBench bench_drift(const DriftBenchSettings& settings);

} // namespace keeler::bench
