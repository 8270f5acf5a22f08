// Sums without rounding: independent of order and grouping, hence of the order of particles in memory, of the number of
// threads, and of how partial sums are combined.
#pragma once

#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// An exact sum of doubles, rounded once in value(). It is the small superaccumulator of Neal (2015, arXiv:1505.05571)
/// with overlapping words, so that carries can be deferred. Terms are buffered and first split into parts that plain
/// additions sum without rounding (Rump, Ogita & Oishi 2008, SIAM J. Sci. Comput. 31, 189).
class ExactSum {
public:
  ExactSum& operator+=(double term) {
    terms_[buffered_++] = term;
    if (buffered_ == max_terms)
      flush_terms();
    return *this;
  }

  ExactSum& operator+=(const ExactSum& more);

  /// Returns the sum as integers, which can be added word by word to the words of up to 2³⁰ other sums. The last word
  /// counts sums with a term that is not finite.
  std::vector<std::uint64_t> words() const;
  /// Inverse of words(), also for added ones. Precondition: as many words as words() returns.
  static ExactSum of_words(std::span<const std::uint64_t> words);

  /// Returns the sum rounded to nearest, ties to even. If a term is not finite, so is the result, as in a plain sum.
  double value() const;

private:
  void flush_terms();
  void add_in_parts(double sum_of_sizes);
  void add_to_words(double term);
  void propagate_carries();

  static constexpr std::size_t max_terms = 128;

  std::array<double, max_terms> terms_{}; // the first buffered_ are not in words_ yet
  std::size_t buffered_ = 0;
  std::array<std::int64_t, 67> words_{}; // in units of 2^(32 w − 1075)
  int added_ = 0;                        // terms since the last propagate_carries()
  double not_finite_ = 0.0;
};

struct ExactVec3 {
  ExactSum x, y, z;

  ExactVec3& operator+=(const Vec3& term) {
    x += term.x();
    y += term.y();
    z += term.z();
    return *this;
  }
  ExactVec3& operator+=(const ExactVec3& more) {
    x += more.x;
    y += more.y;
    z += more.z;
    return *this;
  }
  Vec3 value() const { return {x.value(), y.value(), z.value()}; }
};

/// Returns Total{} after add(total, k) for all k in [0, count), computed with one total per thread. Precondition: Total
/// is independent of order and grouping (it has exact sums) and has +=.
template<class Total, class Add> Total exact_total(std::size_t count, const Add& add) {
  constexpr std::size_t block = 1024;
  std::vector<Total> totals(count <= block ? 1 : static_cast<std::size_t>(threads()));
  parallel_for((count + block - 1) / block,
               [&](std::size_t b) {
                 // inside a parallel region of the caller the thread number may exceed the number of totals
                 Total& total = totals[static_cast<std::size_t>(omp_get_thread_num()) % totals.size()];
                 for (std::size_t k = b * block; k < std::min(count, (b + 1) * block); ++k)
                   add(total, k);
               },
               1);
  for (std::size_t t = 1; t < totals.size(); ++t)
    totals[0] += totals[t];
  return totals[0];
}

/// Returns the sum of term(k) over [0, count), rounded once.
template<class Term> double exact_sum(std::size_t count, const Term& term) {
  return exact_total<ExactSum>(count, [&](ExactSum& total, std::size_t k) { total += term(k); }).value();
}

} // namespace keeler
