// Statistics of a finder's calls: their number by exit, and histograms of iterations and evaluations, as in the paper's
// Figures 5 and 6.
#pragma once

#include <keeler/finders/pair.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

namespace keeler::finders {

struct FinderCounts {
  static constexpr int bins = 64; ///< 0 … 62; the last one holds 63 and above
  using Histogram = std::array<std::uint64_t, bins>;

  /// Calls with one exit.
  struct Calls {
    std::uint64_t count = 0;
    std::uint64_t iterations = 0, evaluations = 0, halvings = 0; ///< summed
    Histogram by_iterations{}, by_evaluations{};

    void merge(const Calls& other) {
      count += other.count;
      iterations += other.iterations;
      evaluations += other.evaluations;
      halvings += other.halvings;
      for (int k = 0; k < bins; ++k) {
        by_iterations[k] += other.by_iterations[k];
        by_evaluations[k] += other.by_evaluations[k];
      }
    }
  };

  std::array<Calls, finder_exits> by_exit{};

  const Calls& of(FinderExit exit) const { return by_exit[static_cast<int>(exit)]; }

  void add(const FinderResult& result) {
    assert(result.iterations >= 0 && result.evaluations >= 0);
    Calls& calls = by_exit[static_cast<int>(result.exit)];
    ++calls.count;
    calls.iterations += result.iterations;
    calls.evaluations += result.evaluations;
    calls.halvings += result.halvings;
    ++calls.by_iterations[std::min(result.iterations, bins - 1)];
    ++calls.by_evaluations[std::min(result.evaluations, bins - 1)];
  }

  void merge(const FinderCounts& other) {
    for (int k = 0; k < finder_exits; ++k)
      by_exit[k].merge(other.by_exit[k]);
  }

  Calls total() const {
    Calls all;
    for (const Calls& calls : by_exit)
      all.merge(calls);
    return all;
  }
};

} // namespace keeler::finders
