// Steps of a simulation, timed in repeats: all clocks and counts of a step and of the drift in it, what the machine can
// do in the same moments, and what several threads gain over one.
#pragma once

#include <keeler/core/phase_progress.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cstddef>
#include <cstdint>

namespace keeler {

/// Wall time of the parts of a step, ns per particle and step; they make up the whole but for what is between them.
struct StepSplit {
  double drift = 0.0;   ///< finding and carrying out collisions
  double advance = 0.0; ///< to the next epoch and back into the cell
  double gravity = 0.0; ///< solves; those of other forces too
  double kick = 0.0;
};

/// Wall time of the parts of a drift, ns per particle and step; they make up StepSplit::drift in the same way.
struct DriftSplit {
  double build = 0.0;  ///< neighbour lists made or mended, near pairs picked
  double reject = 0.0; ///< finding out which of these cannot touch in the step
  double solve = 0.0;  ///< searches at the start of steps
  double events = 0.0; ///< carrying out contacts, and all searches that follow
};

/// What this machine can do, measured in between, on the same number of threads.
struct Yardsticks {
  double line_ns = 0.0; ///< to read and write back a line of 64 bytes, of as many as there are particles, in order
  double pair_ns = 0.0; ///< to evaluate |d|² and d·v of a pair on its epicycles at one time, from the fastest memory
};

/// Wall time on one thread over that on several, each repeat followed by as many steps on one thread: medians of the
/// ratios. All 1 on one thread, and where there is no such part. Of a run that ranks share: on the first rank alone
/// over that of all.
struct Speedups {
  double step = 1.0;
  double drift = 1.0, events = 1.0, gravity = 1.0; ///< of these parts alone
  double pair = 1.0;                               ///< of the yardstick pair_ns, whose threads share nothing
};

/// What ranks tell each other: means over the ranks, all 0 on one.
struct ExchangeSplit {
  double ns = 0.0;                    ///< of a rank's wall time per particle of the run and step, waiting included
  double messages = 0.0, bytes = 0.0; ///< that a rank sends in a step
  double common = 0.0;                ///< calls in a step in which all get the same
};

/// Times are medians over the repeats: processor time on one thread, wall time on several threads or ranks, the splits
/// always wall time, of the first rank. Counts are of all repeats, and ranks, together.
struct TimedSteps {
  std::size_t count = 0;      ///< particles there are
  std::size_t ranks = 1;      ///< that share them
  int steps = 0, repeats = 0; ///< timed in each repeat, and how often
  double ns_per_particle_step = 0.0;
  StepSplit split;
  DriftSplit drift_split;
  Yardsticks yardsticks;
  Speedups speedup;
  ExchangeSplit exchange;
  std::uint64_t repeated_steps = 0; ///< steps that ranks did again
  std::uint64_t collisions = 0;     ///< faster than v_cut
  std::uint64_t contacts = 0;       ///< fast and slow
  std::uint64_t recontacts = 0, lists_made = 0, listed_anew = 0, deferred = 0, in_sequence = 0, rolled_back = 0;
  std::uint64_t pairs_tested = 0;     ///< when neighbours were found
  std::uint64_t survivors = 0;        ///< handed to the finder at the start of steps
  std::uint64_t widest_list = 0;      ///< since the simulation was made
  std::size_t bytes_per_particle = 0; ///< held by the drift phase at the end, of one particle of a rank

  /// A number of all repeats, for each particle and step.
  double per_particle_step(std::uint64_t number) const {
    return static_cast<double>(number) / (static_cast<double>(count) * steps * repeats);
  }
  /// A time per particle and step, ns, for each contact; 0 when there were none.
  double per_contact(double ns) const { return contacts > 0 ? ns / per_particle_step(contacts) : 0.0; }
};

/// Enough steps for a repeat: as long as neighbour lists live at most, where that does not take too long, and more than
/// two windows of the drift anyway; at most `most` beyond that. `step` in orbits.
double steps_worth_timing(std::size_t count, double step, double most);

/// A few untimed steps, in which buffers grow and lists are first made, then the repeats; each goes on where the one
/// before it stopped, or the steps on one thread after it. All steps come in whole kick intervals; `steps` is a
/// multiple of them. Collective where ranks share the simulation: `alone` is then one of the same state, which each
/// repeat is followed by, on the first rank; null on the others.
TimedSteps time_steps(Simulation& simulation, int steps, int repeats, int kick_every, PhaseProgress& progress,
                      Simulation* alone = nullptr);

} // namespace keeler
