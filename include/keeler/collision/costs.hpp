// What the drift phase did and what it cost, since it was made: for benchmarks, reports and tuning. Nothing in it
// belongs to a run's state.
#pragma once

#include <cstddef>
#include <cstdint>

namespace keeler {

struct DriftCosts {
  // wall time, s
  double build = 0.0;  ///< beginning steps: lines, who left its slack, lists, near pairs
  double reject = 0.0; ///< going through the near pairs for those that may touch in the step
  double solve = 0.0;  ///< searches at the start of steps
  double events = 0.0; ///< carrying out contacts and all searches that follow

  // counts
  std::uint64_t steps = 0;
  std::uint64_t lists_made = 0;   ///< how often all neighbour lists were made
  std::uint64_t pairs_tested = 0; ///< pairs that the cells brought together for that, or to list one anew
  std::uint64_t listed = 0;       ///< pairs on all lists when they were made
  std::uint64_t survivors = 0;    ///< pairs handed to the finder at the start of steps
  std::uint64_t contacts = 0;     ///< contacts carried out
  std::uint64_t recontacts = 0;   ///< of these, with the partner of both particles' last contact in the same step
  std::uint64_t listed_anew = 0;  ///< particles that got a new list because they left their slack
  std::uint64_t deferred = 0;     ///< events that the domains of the first round left to the second
  std::uint64_t in_sequence = 0;  ///< events that those of the second left to the last, which is one for all
  std::uint64_t rolled_back = 0;  ///< contacts, because a deferred one had a say in them
  std::uint64_t widest_list = 0;  ///< most partners of one particle within one search

  std::uint64_t repeated_steps =
      0;                          ///< steps that ranks did again, because a copy went another way than its owner says,
  std::uint64_t rounds_again = 0; ///< and how often

  /// Held by the drift phase now, the particles themselves included; without the records that an observer asks for.
  std::size_t bytes_per_particle = 0;
};

} // namespace keeler
