// Times whole steps with gravity and collisions: in a state of gravity_states.hpp, or in a snapshot.
#pragma once

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/bench/timed_steps.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/core/progress.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace keeler::bench {

struct StepBenchSettings {
  std::size_t count = 100000;        ///< rounded to whole tiles
  std::string state = "settled";     ///< one of gravity_state_names()
  std::optional<std::string> from;   ///< a snapshot to time with its scene; `count` and `state` are then ignored
  std::optional<int> kick_every;     ///< default: 1, or the value of the snapshot's scene
  std::optional<std::string> solver; ///< with its default settings; default: tree, or the snapshot's solver
  int repeats = 5;
  Communicator ranks;                            ///< ranks of a distributed run
  std::function<void(const Progress&)> progress; ///< may be empty
};

struct StepBench {
  GravityChoice choice;
  double preparation_s = 0.0; ///< wall time to make or read the state
  double step_orbits = 0.0;
  double dispersion_r_omega = 0.0; ///< c_x of the timed state, ⟨r⟩ Ω
  TimedSteps timed;                ///< of whole kick intervals
};

/// Makes or reads the state and times it. Collective; the result is valid on rank 0. Precondition: count, repeats and
/// kick_every are positive. Throws UsageError for a snapshot without gravity in its scene, and what read_snapshot(),
/// patch_from_snapshot() and Simulation throw.
StepBench bench_step(const StepBenchSettings& settings);

} // namespace keeler::bench
