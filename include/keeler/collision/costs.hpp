// What the drift phase did and what it cost, since it was made: for benchmarks, reports and tuning. Nothing in it
// belongs to a run's state.
#pragma once

#include <cstddef>
#include <cstdint>

namespace keeler {

struct DriftCosts {
  // wall time, s
  double build = 0.0;  ///< beginning steps; at the first of a window, sorting particles and listing pairs
  double reject = 0.0; ///< going through the lists for pairs that may touch in the step
  double solve = 0.0;  ///< searches at the start of steps
  double events = 0.0; ///< carrying out contacts and all searches that follow

  // counts
  std::uint64_t steps = 0;
  std::uint64_t windows = 0;      ///< how often neighbours were found anew
  std::uint64_t pairs_tested = 0; ///< pairs that the cells brought together when a window began
  std::uint64_t listed = 0;       ///< pairs of those that were kept for the window
  std::uint64_t survivors = 0;    ///< pairs handed to the finder at the start of steps
  std::uint64_t contacts = 0;     ///< contacts carried out
  std::uint64_t recontacts = 0;   ///< of these, with the partner of both particles' last contact in the same step
  std::uint64_t conflicts = 0;    ///< contacts of one strip that came before another strip's
  std::uint64_t repairs = 0;      ///< strips undone because of that
  std::uint64_t widest_list = 0;  ///< most partners of one particle within one search

  std::size_t bytes_per_particle = 0; ///< held by the drift phase now, the particles themselves included
};

} // namespace keeler
