// Decides how long lists and pruning intervals last, and when all lists are rebuilt. It sees counts, no particles and
// no clock, so its decisions are the same on every machine and for any number of threads.
#pragma once

#include "step_interval.hpp"

#include <cstddef>
#include <cstdint>

namespace keeler::collision {

class RebuildPolicy {
public:
  /// Begins a step. `undisturbed`: only hits have changed the paths since the last one.
  void begin_step(bool undisturbed);

  /// Chooses the lifetime of new lists in steps by hill climbing: longer (or shorter) as long as that lowers the cost
  /// per step, then back. `lists`: the previous ones; their cost counts if they were `valid` to the end. `step`: length
  /// of a step, rad.
  int choose_lifetime(bool valid, const StepInterval& lists, double step);
  /// Halves the chosen lifetime and returns it. Precondition: it is more than 1.
  int halve_lifetime();

  /// Returns the length of a new pruning interval in steps. It ends with the lists or when a disturbance is expected,
  /// and is so short that few particles will become dirty. In the previous interval `dirty` of `particles` became so in
  /// `steps` steps.
  int pruning_interval(std::size_t dirty, std::size_t particles, int steps, const StepInterval& lists,
                       double step) const;

  /// True if rebuilding all lists is cheaper than a new list for each of `escaped` particles.
  bool better_rebuild_all(std::size_t escaped, std::size_t particles) const;

  // The following calls count what is done for the present lists. Single lists rebuilt within a step are counted for
  // better_rebuild_all() alone.
  void rebuilt_all(std::size_t particles, std::uint64_t tests, std::uint64_t entries);
  void renewed_one() { ++renewed_; }
  void updated(std::size_t escaped);
  void pruned(std::uint64_t pairs);
  void hit(std::uint64_t entries_of_dirty);

  /// Returns the costs of the present lists so far, ns on a typical processor.
  double cost() const { return cost_; }

private:
  int undisturbed_ = 0, last_undisturbed_ = 1 << 20; // steps since the last disturbance, and between the last two
  int lifetime_ = 10;                                // of the next lists, steps
  double growth_ = 1.4;                              // of the lifetime; at first in long strides
  double cost_ = 0.0;
  double last_cost_ = 0.0;  // of the previous lists, per step
  std::size_t renewed_ = 0; // lists rebuilt one by one
};

} // namespace keeler::collision
