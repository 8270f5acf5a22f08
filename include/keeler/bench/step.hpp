// What a whole step costs, gravity and collisions, in the clumped state of gravity_bench.hpp.
#pragma once

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/core/progress.hpp>

#include <cstddef>
#include <functional>
#include <string>

namespace keeler {

struct StepBenchSettings {
  std::size_t count = 100000; ///< rounded to whole tiles, and up to what two λ_cr by two hold
  int kick_every = 1;
  std::string solver = "tree"; ///< with the settings of default_gravity_choice()
  int repeats = 5;
  std::function<void(const Progress&)> progress; ///< may be empty
};

/// Wall time of the parts of a step, ns per particle and step; they make up the whole but for what is between them.
struct StepSplit {
  double drift = 0.0;   ///< finding and carrying out collisions
  double advance = 0.0; ///< to the next epoch and back into the cell
  double gravity = 0.0; ///< solves
  double kick = 0.0;
};

/// Times are medians over the repeats: processor time on one thread, wall time on several, the split always wall time.
struct StepBench {
  GravityChoice choice;
  std::size_t count = 0; ///< particles there are
  int steps = 0;         ///< timed in each repeat: whole kick intervals
  double step_orbits = 0.0;
  double ns_per_particle_step = 0.0;
  StepSplit split;
  double collisions_per_particle_step = 0.0; ///< faster than v_cut, over all repeats
};

/// Each repeat goes on where the one before it stopped. Throws what Simulation throws.
StepBench bench_step(const StepBenchSettings& settings);

} // namespace keeler
