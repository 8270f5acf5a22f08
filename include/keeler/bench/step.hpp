// What a whole step costs, gravity and collisions: in the clumped state of gravity_states.hpp, or in a snapshot.
#pragma once

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/bench/timed_steps.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/core/progress.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace keeler {

struct StepBenchSettings {
  std::size_t count = 100000;        ///< rounded to whole tiles, and up to what two λ_cr by two hold
  std::optional<std::string> from;   ///< a snapshot to time as it stands, with the scene in it; `count` is not read
  std::optional<int> kick_every;     ///< none: 1, or what the snapshot's scene has
  std::optional<std::string> solver; ///< with its default settings; none: tree, or what the snapshot's scene has
  int repeats = 5;
  Communicator ranks;                            ///< that share the steps
  std::function<void(const Progress&)> progress; ///< may be empty
};

struct StepBench {
  GravityChoice choice;
  double step_orbits = 0.0;
  double dispersion_r_omega = 0.0; ///< c_x of the state that is timed, in ⟨r⟩ Ω
  TimedSteps timed;                ///< in whole kick intervals
};

/// Collective; the first rank's is the result. Throws UsageError for a snapshot whose scene has no gravity, and what
/// read_snapshot(), patch_from_snapshot() and Simulation throw.
StepBench bench_step(const StepBenchSettings& settings);

} // namespace keeler
