// What the drift phase did and what it cost since it was made: for benchmarks, reports and tuning. Nothing here belongs
// to a run's state.
#pragma once

#include <cstddef>
#include <cstdint>

namespace keeler::collision {

struct DriftCosts {
  // wall time, s
  double build = 0.0;  ///< beginning steps: lines, particles outside their skin, lists, pruned pairs
  double reject = 0.0; ///< rejecting pruned pairs that cannot touch in the step
  double solve = 0.0;  ///< searches at the start of steps
  double events = 0.0; ///< carrying out contacts, and all searches that follow

  // counts
  std::uint64_t steps = 0;
  std::uint64_t lists_made = 0;    ///< rebuilds of all neighbour lists
  std::uint64_t pairs_tested = 0;  ///< pairs that the cells offered for that, or to rebuild one list
  std::uint64_t listed = 0;        ///< pairs on all lists when they were made
  std::uint64_t survivors = 0;     ///< pairs that the finder was asked about at the start of steps
  std::uint64_t contacts = 0;      ///< contacts carried out
  std::uint64_t recontacts = 0;    ///< of these: the last contact of both particles in the step was with each other
  std::uint64_t lists_rebuilt = 0; ///< single lists rebuilt because their particle left its skin
  std::uint64_t deferred = 0;      ///< events that the first round of domains left to the second
  std::uint64_t in_sequence = 0;   ///< events left to the last round, which is one domain
  std::uint64_t rolled_back = 0;   ///< contacts that a deferred one contradicted
  std::uint64_t abandoned = 0;     ///< times that domains left a step to the sequential loop
  std::uint64_t widest_list = 0;   ///< largest number of partners of one particle within one search

  // distributed steps
  std::uint64_t repeated_steps = 0;  ///< steps repeated because a ghost's path differed from its owner's
  std::uint64_t repeated_rounds = 0; ///< repetitions in all

  /// Memory of the drift phase and of the particles; without records that an observer asks for.
  std::size_t bytes_per_particle = 0;
};

} // namespace keeler::collision
