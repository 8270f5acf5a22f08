// How the calls of a finder ended: by exit reason, with histograms of iterations and of motion evaluations.
#pragma once

#include <keeler/collision/pair.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace keeler {

struct FinderCounts {
  static constexpr int bins = 64; ///< 0 … 62, and one for all above
  using Histogram = std::array<std::uint64_t, bins>;

  std::array<Histogram, finder_exits> iterations{};  ///< by exit reason
  std::array<Histogram, finder_exits> evaluations{}; ///< by exit reason
  std::uint64_t all_evaluations = 0;

  void add(const FinderResult& result) {
    const auto exit = static_cast<std::size_t>(result.exit);
    ++iterations[exit][static_cast<std::size_t>(std::min(result.iterations, bins - 1))];
    ++evaluations[exit][static_cast<std::size_t>(std::min(result.evaluations, bins - 1))];
    all_evaluations += static_cast<std::uint64_t>(result.evaluations);
  }

  std::uint64_t calls(FinderExit exit) const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : iterations[static_cast<std::size_t>(exit)])
      sum += count;
    return sum;
  }

  std::uint64_t calls() const {
    std::uint64_t sum = 0;
    for (int exit = 0; exit < finder_exits; ++exit)
      sum += calls(static_cast<FinderExit>(exit));
    return sum;
  }

  /// Calls that reported a contact.
  std::uint64_t contacts() const { return calls(FinderExit::hit) + calls(FinderExit::overlapping); }
};

} // namespace keeler
