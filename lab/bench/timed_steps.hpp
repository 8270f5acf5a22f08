// Times the steps of a simulation in repeats: all clocks and counts of a step and its drift, the speed of the machine
// at that time, and the speedup by several threads or ranks.
#pragma once

#include <keeler/core/phase_progress.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace keeler::bench {

/// Wall time of the parts of a step, ns per particle and step. Their sum is the step except for small gaps between
/// them.
struct StepSplit {
  double drift = 0.0;   ///< finding and carrying out collisions
  double advance = 0.0; ///< moving to the next epoch and wrapping into the cell
  double gravity = 0.0; ///< evaluating gravity and other forces
  double kick = 0.0;
};

/// Wall time of the parts of a drift, ns per particle and step. Their sum is StepSplit::drift except for small gaps.
struct DriftSplit {
  double build = 0.0;  ///< building and repairing neighbour lists, pruning pairs
  double reject = 0.0; ///< rejecting pairs that cannot touch in the step
  double solve = 0.0;  ///< searches at the start of a step
  double events = 0.0; ///< resolving contacts, and all searches after them
};

/// Speed of this machine, measured between the repeats on the same number of threads.
struct Yardsticks {
  double line_ns = 0.0; ///< reading and writing a line of 64 bytes, in order, in an array with one line per particle
  double pair_ns = 0.0; ///< evaluating |d|² and d·v of a pair on its epicycles at one time, from the fastest cache
};

/// Speedups: wall time on one thread over wall time on several, as median of the ratios; each repeat is followed by the
/// same number of steps on one thread. In a distributed run: wall time on rank 0 alone over wall time on all ranks. All
/// are 1 on one thread, and for parts that the run lacks.
struct Speedups {
  double step = 1.0;
  double drift = 1.0, events = 1.0, gravity = 1.0; ///< of these parts
  double pair = 1.0;                               ///< of Yardsticks::pair_ns, which shares no data between threads
};

/// Communication between ranks: means over the ranks, all 0 on one rank.
struct ExchangeSplit {
  double ns = 0.0;                    ///< wall time of a rank per particle of the run and step, waiting included
  double messages = 0.0, bytes = 0.0; ///< sent per rank and step
  double common = 0.0;                ///< collective calls per step
};

/// The result of time_steps(). Times are medians over the repeats: processor time on one thread, wall time on several
/// threads or ranks; the splits are always wall time of rank 0. Counts are sums over all repeats and ranks.
struct TimedSteps {
  std::size_t count = 0;      ///< particles of the run
  std::size_t ranks = 1;      ///< ranks of the run
  int steps = 0, repeats = 0; ///< steps per repeat; repeats
  double ns_per_particle_step = 0.0;
  StepSplit split;
  DriftSplit drift_split;
  Yardsticks yardsticks;
  Speedups speedup;
  ExchangeSplit exchange;
  std::uint64_t repeated_steps = 0; ///< steps that ranks repeated
  std::uint64_t collisions = 0;     ///< faster than v_cut
  std::uint64_t contacts = 0;       ///< fast and slow collisions
  std::uint64_t recontacts = 0, lists_made = 0, lists_rebuilt = 0, deferred = 0, in_sequence = 0, rolled_back = 0;
  std::uint64_t pairs_tested = 0;     ///< when neighbour lists were built
  std::uint64_t survivors = 0;        ///< pairs passed to the finder at the start of steps
  std::uint64_t widest_list = 0;      ///< longest list since the simulation began
  std::size_t bytes_per_particle = 0; ///< memory of the drift phase at the end, per particle of a rank

  /// Converts a sum over all repeats to a number per particle and step. Precondition: time_steps() made this object.
  double per_particle_step(std::uint64_t number) const {
    assert(count > 0 && steps > 0 && repeats > 0);
    return static_cast<double>(number) / (static_cast<double>(count) * steps * repeats);
  }
  /// Converts a time per particle and step (ns) to a time per contact; 0 without contacts.
  double per_contact(double ns) const { return contacts > 0 ? ns / per_particle_step(contacts) : 0.0; }
};

/// Returns the number of steps of a repeat: enough for a precise time, at least two pruning intervals of the drift, and
/// at least the longest lifetime of neighbour lists unless that takes too long; otherwise at most `limit`. `step` is
/// in orbits. Precondition: `step` > 0.
double steps_worth_timing(std::size_t count, double step, double limit);

/// Makes some untimed steps, in which buffers grow and lists are first built, then the repeats. The simulation
/// continues from repeat to repeat. Collective in a distributed run: rank 0 then passes `alone`, an undistributed
/// simulation of the same state for the comparison after each repeat, and the other ranks nullptr. Precondition:
/// `repeats` and `kick_every` > 0, and `steps` is a positive multiple of `kick_every`.
TimedSteps time_steps(Simulation& simulation, int steps, int repeats, int kick_every, PhaseProgress& progress,
                      Simulation* alone = nullptr);

} // namespace keeler::bench
