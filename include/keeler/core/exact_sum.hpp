// Sums without rounding, so that neither their order nor their grouping counts: of particles in any order of memory, on
// any number of threads, and in pieces that are added up later.
#pragma once

#include <keeler/core/threads.hpp>
#include <keeler/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// A sum of any doubles, exact until it is read: a superaccumulator whose words overlap, so that carries can wait (the
/// small one of Neal 2015, arXiv:1505.05571). Terms wait too, and are first split into parts that plain additions sum
/// without rounding (Rump, Ogita & Oishi 2008, SIAM J. Sci. Comput. 31, 189).
class ExactSum {
public:
  ExactSum& operator+=(double term) {
    terms_[waiting_++] = term;
    if (waiting_ == max_terms)
      take_terms();
    return *this;
  }

  ExactSum& operator+=(const ExactSum& more);

  /// The sum as whole numbers, to be added word by word to those of up to 2³⁰ other sums; the last counts terms that
  /// were not finite.
  std::vector<std::uint64_t> words() const;
  /// The sum of such ones.
  static ExactSum of_words(std::span<const std::uint64_t> words);

  /// The double nearest to the sum, of two the even one. Infinite or not a number as a plain sum, where a term was.
  double value() const;

private:
  void take_terms();
  void take_in_parts(double sizes);
  void take(double term);
  void carry();

  static constexpr std::size_t max_terms = 128;

  std::array<double, max_terms> terms_{}; // the first ones wait to be taken
  std::size_t waiting_ = 0;
  std::array<std::int64_t, 67> words_{}; // in units of 2^(32 w − 1075)
  int taken_ = 0;                        // since the last carry
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

/// What add(total, k) makes of Total{} over k in [0, count), where neither order nor grouping counts: each thread has a
/// total of its own. Total holds exact sums and has +=.
template<class Total, class Add> Total exact_total(std::size_t count, const Add& add) {
  constexpr std::size_t block = 1024;
  std::vector<Total> totals(count <= block ? 1 : static_cast<std::size_t>(threads()));
  parallel_for((count + block - 1) / block,
               [&](std::size_t b) {
                 // a loop on the calling thread alone has the number that this one has in a region of the caller's
                 Total& total = totals[static_cast<std::size_t>(omp_get_thread_num()) % totals.size()];
                 for (std::size_t k = b * block; k < std::min(count, (b + 1) * block); ++k)
                   add(total, k);
               },
               1);
  for (std::size_t t = 1; t < totals.size(); ++t)
    totals[0] += totals[t];
  return totals[0];
}

/// Sum of term(k) over [0, count), rounded once.
template<class Term> double exact_sum(std::size_t count, const Term& term) {
  return exact_total<ExactSum>(count, [&](ExactSum& total, std::size_t k) { total += term(k); }).value();
}

} // namespace keeler
