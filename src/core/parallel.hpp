// Parallel loops and sums. Results are bitwise independent of the number of threads: each index is processed by exactly
// one thread, and the order of additions depends only on the length.
#pragma once

#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <exception>
#include <vector>

namespace keeler {

/// Stores the first exception of several threads, for the thread that waits for them.
class FirstException {
public:
  /// Stores the exception that is being handled, unless there is one already. Precondition: called in a catch clause.
  void keep() noexcept {
    if (!any_.exchange(true, std::memory_order_relaxed))
      first_ = std::current_exception();
  }
  bool any() const { return any_.load(std::memory_order_relaxed); }
  /// Rethrows the exception, if there is one. Precondition: the other threads have ended.
  void rethrow() const {
    if (first_)
      std::rethrow_exception(first_);
  }

private:
  std::atomic<bool> any_ = false;
  std::exception_ptr first_;
};

/// Calls body(k) once for each k in [0, count), in unspecified order; body must write only data of k. A single chunk
/// runs on the calling thread. Throws Interrupted, after the current chunks, if the work is to be abandoned
/// (interrupt.hpp). An exception of body, such as a failed allocation, ends the loop likewise and is rethrown on the
/// calling thread. Precondition: chunk > 0.
///
/// Each thread begins with a fixed range that depends only on count, for locality between loops; then it steals chunks
/// from the ranges of other threads.
template<class Body> void parallel_for(std::size_t count, const Body& body, std::size_t chunk = 256) {
  assert(chunk > 0);
  struct alignas(64) Range {
    std::atomic<std::size_t> next = 0;
    std::size_t end = 0;
  };
  FirstException failure;
  const auto work_on = [&](Range& range) {
    for (std::size_t begin; !interrupted() && !failure.any() &&
                            (begin = range.next.fetch_add(chunk, std::memory_order_relaxed)) < range.end;)
      for (std::size_t k = begin; k < std::min(begin + chunk, range.end); ++k)
        body(k);
  };
  const auto ranges_count = static_cast<std::size_t>(threads());
  if (ranges_count == 1 || count <= chunk) {
    for (std::size_t begin = 0; begin < count; begin += chunk) {
      throw_if_interrupted();
      for (std::size_t k = begin; k < std::min(begin + chunk, count); ++k)
        body(k);
    }
    return;
  }
  std::vector<Range> ranges(ranges_count);
  for (std::size_t r = 0; r < ranges_count; ++r) {
    ranges[r].next = count * r / ranges_count;
    ranges[r].end = count * (r + 1) / ranges_count;
  }
  const std::atomic<bool>& flag = Interruptible::flag();
#pragma omp parallel
  {
    const Interruptible as_caller(flag);
    try {
      for (std::size_t r = 0; r < ranges_count; ++r)
        work_on(ranges[(static_cast<std::size_t>(omp_get_thread_num()) + r) % ranges_count]);
    } catch (...) {
      failure.keep();
    }
  }
  failure.rethrow();
  throw_if_interrupted();
}

/// Returns Total{} after add(total, k) for all k in [0, count). Blocks of fixed length have separate totals, which are
/// added in order with +=, so the bits do not depend on the threads. Total may contain several sums.
template<class Total, class Add> Total ordered_total(std::size_t count, const Add& add) {
  constexpr std::size_t block = 1024;
  std::vector<Total> totals((count + block - 1) / block);
  parallel_for(
      totals.size(),
      [&](std::size_t b) {
        Total total{};
        for (std::size_t k = b * block; k < std::min(count, (b + 1) * block); ++k)
          add(total, k);
        totals[b] = total;
      },
      1);
  Total total{};
  for (const Total& part : totals)
    total += part;
  return total;
}

/// Returns the sum of term(k) over [0, count), by ordered_total().
template<class Term> double ordered_sum(std::size_t count, const Term& term) {
  return ordered_total<double>(count, [&](double& total, std::size_t k) { total += term(k); });
}

/// Returns the maximum of 0 and of term(k) over [0, count); NaN if any term is NaN.
template<class Term> double largest_of(std::size_t count, const Term& term) {
  struct Largest {
    double value = 0.0;
    void operator+=(const Largest& other) {
      if (other.value > value || std::isnan(other.value))
        value = other.value;
    }
  };
  return ordered_total<Largest>(count, [&](Largest& most, std::size_t k) { most += {term(k)}; }).value;
}

} // namespace keeler
