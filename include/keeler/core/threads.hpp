// Threads. Every result is the same, bit for bit, for any number of them: loops give each index to exactly one thread,
// and sums are made in an order that depends on the length alone.
#pragma once

#include <keeler/core/interrupt.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <exception>
#include <vector>

namespace keeler {

/// More threads than any one machine has processors for: they only take memory, until there is none.
inline constexpr int max_threads = 1024;

/// How many threads loops use from now on (at least 1). The default is what OpenMP offers. Throws UsageError when there
/// are more than most_threads.
void set_threads(int count);
int threads();

/// The first exception that one of several threads met, for the thread that waits for them.
class FirstException {
public:
  /// Keeps the exception that is being handled, unless there is one already.
  void keep() noexcept {
    if (!any_.exchange(true, std::memory_order_relaxed))
      first_ = std::current_exception();
  }
  bool any() const { return any_.load(std::memory_order_relaxed); }
  /// Throws it, if there is one. Precondition: the other threads have ended.
  void rethrow() const {
    if (first_)
      std::rethrow_exception(first_);
  }

private:
  std::atomic<bool> any_ = false;
  std::exception_ptr first_;
};

/// Calls body(k) once for each k in [0, count), in no promised order; body must write only what belongs to k.
/// What fits in one chunk runs on the calling thread. Throws Interrupted after the chunks at hand when the work is to
/// be given up (interrupt.hpp). An exception of body, no memory for instance, ends the loop in the same way and is
/// thrown on the calling thread.
///
/// Each thread begins with a range of its own, the same one in every loop of that length, so that it meets its memory
/// again; then it helps the others, a chunk at a time.
template<class Body> void parallel_for(std::size_t count, const Body& body, std::size_t chunk = 256) {
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

/// What add(total, k) makes of Total{} over k in [0, count): blocks of fixed length, their totals added in order with
/// +=, so the bits do not depend on the threads. Total may hold several sums, made in one pass.
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

/// Sum of term(k) over [0, count), made in the same way.
template<class Term> double ordered_sum(std::size_t count, const Term& term) {
  return ordered_total<double>(count, [&](double& total, std::size_t k) { total += term(k); });
}

/// The largest term(k) over [0, count) and 0; not a number when any of them is not.
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
