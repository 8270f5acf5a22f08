// Decides how long lists and pruning intervals last, and when all lists are rebuilt. It sees counts, no particles and
// no clock, so its decisions are the same on every machine and for any number of threads.
#pragma once

#include "step_interval.hpp"

#include <cstddef>
#include <cstdint>

namespace keeler {

class RebuildPolicy {
public:
  /// A step begins. `undisturbed`: nothing but hits has changed the paths since the last one.
  void begin_step(bool undisturbed);

  /// Chooses the lifetime of new lists by hill climbing on the cost per step of the lists so far: on in the same
  /// direction as long as that helps. `lived`: the lists so far ended by themselves, so their cost tells something.
  /// Returns steps, at least 1. `step` is a step's length, rad.
  int choose_lifetime(bool lived, const StepInterval& lists, double step);
  /// Returns half the lifetime chosen. Precondition: it is more than 1.
  int halve_lifetime();

  /// Returns the length of a new pruning interval in steps: until the next disturbance or the end of the lists, as far
  /// as the last interval lets expect, and so that few particles become dirty. `dirty` particles of `particles` became
  /// so in the `steps` steps of the interval before.
  int pruning_interval(std::size_t dirty, std::size_t particles, int steps, const StepInterval& lists,
                       double step) const;

  /// True if rebuilding all lists is cheaper than one more list for each of `escaped` particles.
  bool better_rebuild_all(std::size_t escaped, std::size_t particles) const;

  // What has been done, for the costs.
  void rebuilt_all(std::size_t particles, std::uint64_t tests, std::uint64_t entries);
  void renewed_one() { ++renewed_; }
  void updated(std::size_t escaped);
  void pruned(std::uint64_t pairs);
  void hit(std::uint64_t entries_of_dirty);

  /// Costs of the present lists so far, ns on a usual processor.
  double cost() const { return cost_; }

private:
  int undisturbed_ = 0, last_undisturbed_ = 1 << 20; // steps without a disturbance: up to now, and the last time
  int lifetime_ = 10;                                // of the next lists, steps
  double growth_ = 1.4;                              // of the lifetime; at first in long strides
  double cost_ = 0.0;
  double last_cost_ = 0.0;  // of the lists before, per step
  std::size_t renewed_ = 0; // lists rebuilt one by one
};

} // namespace keeler
