// Repeated work that takes only a small part of the time.
#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <ctime>

namespace keeler::live_view {

/// Returns the processor time of this thread, s. On a busy machine, work waits for longer.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Throttle {
public:
  using Clock = std::chrono::steady_clock;

  /// Begins are at least `interval` (s) apart, and the work takes at most this fraction of the time.
  Throttle(double interval, double fraction) : interval_(interval), fraction_(fraction) {
    assert(interval >= 0.0 && fraction > 0.0);
  }

  bool due() const { return Clock::now() >= next_; }

  /// Does the work, which is then due again after a while. `more` is processor time (s) that was spent for it
  /// elsewhere, and `processors` how many there are to take a fraction of.
  template<class Work> void spend(const Work& work, double more = 0.0, int processors = 1) {
    assert(more >= 0.0 && processors > 0);
    const Clock::time_point begin = Clock::now();
    const double before = thread_seconds();
    work();
    const double spent = (thread_seconds() - before + more) / processors;
    next_ = begin + std::chrono::duration_cast<Clock::duration>(
                        std::chrono::duration<double>(std::max(interval_, spent / fraction_)));
  }

private:
  double interval_, fraction_;
  Clock::time_point next_ = Clock::time_point::min();
};

} // namespace keeler::live_view
