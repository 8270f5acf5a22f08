// What a step of the drift phase costs: spheres without gravity, in collisional equilibrium at ε = 0.5.
#pragma once

#include <keeler/core/progress.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace keeler {

enum class BenchSizes {
  equal,  ///< 1 m
  power,  ///< n(r) dr ∝ r⁻³ from 1 m to 100 m
  moonlet ///< 1 m, and one sphere of 100 m
};

struct DriftBenchSettings {
  std::size_t count = 10000; ///< rounded to whole tiles in a large state, and by what a moonlet covers
  double step_orbits = 1e-3;
  double optical_depth = 0.5; ///< of a moonlet's state: outside of the moonlet
  BenchSizes sizes = BenchSizes::equal;
  std::string finder = "certified";
  int repeats = 5;
  bool all_pairs = false;                        ///< every grid candidate goes to the finder
  std::function<void(const Progress&)> progress; ///< may be empty
};

/// Wall time of the parts of a drift, ns per particle and step.
struct DriftSplit {
  double advance = 0.0; ///< to the next epoch and back into the cell
  double build = 0.0;   ///< sorting places into cells
  double reject = 0.0;  ///< finding out which pairs cannot touch
  double solve = 0.0;   ///< searches at the start of steps
  double events = 0.0;  ///< carrying out contacts, and all searches that follow
};

/// What this machine can do, measured in between, on the same number of threads.
struct Yardsticks {
  double line_ns = 0.0; ///< to read and write back a line of 64 bytes, of as many as there are particles, in order
  double pair_ns = 0.0; ///< to evaluate |d|² and d·v of a pair on its epicycles at one time, from the fastest memory
};

/// Wall time on one thread over that on several, each repeat followed by as many steps on one thread: medians of the
/// ratios. All 1 on one thread.
struct Speedups {
  double step = 1.0;
  double events = 1.0; ///< of that part alone
  double pair = 1.0;   ///< of the yardstick pair_ns, whose threads share nothing
};

/// Times are medians over the repeats: processor time on one thread, wall time on several, the split always wall time.
/// Counts are of all repeats together.
struct DriftBench {
  std::size_t count = 0; ///< particles there are
  int steps = 0;         ///< timed in each repeat
  double ns_per_particle_step = 0.0;
  DriftSplit split;
  double ns_per_collision = 0.0;        ///< all of that time over the contacts carried out; 0 when there were none
  double ns_events_per_collision = 0.0; ///< the split's events over them
  double ns_per_call = 0.0;             ///< of the finder, on the pairs that the first step hands to it; one thread
  double calls_per_particle_step = 0.0;
  double pairs_per_particle = 0.0;            ///< tested when neighbours are found, a step
  double survivors_per_particle = 0.0;        ///< handed to the finder at the start of a step
  double collisions_per_particle_orbit = 0.0; ///< faster than v_cut
  std::uint64_t contacts = 0;                 ///< fast and slow
  std::uint64_t recontacts = 0, conflicts = 0, repairs = 0, windows = 0;
  std::uint64_t widest_list = 0;
  std::size_t bytes_per_particle = 0;
  Yardsticks yardsticks;
  Speedups speedup;
  double dispersion_r_omega = 0.0; ///< c_x of the state that is timed, in ⟨r⟩ Ω
};

/// Each repeat goes on where the one before it stopped, or the steps on one thread after it. Throws UsageError for an
/// unknown finder or an impossible patch.
DriftBench bench_drift(const DriftBenchSettings& settings);

} // namespace keeler
