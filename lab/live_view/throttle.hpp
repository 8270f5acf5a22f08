// Repeated work that takes only a small part of the time.
#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <ctime>
#include <thread>

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

  enum class Of { wall_time, thread_time };

  /// Begins are at least `interval` (s) apart, and the work takes at most this fraction of the time that passes, or of
  /// the processor time of the thread that calls: on a busy machine it has less of that.
  Throttle(double interval, double fraction, Of of = Of::wall_time)
      : interval_(interval), fraction_(fraction), of_(of) {
    assert(interval >= 0.0 && fraction > 0.0);
  }

  bool due() const {
    const bool is_rested =
        of_ == Of::wall_time || std::this_thread::get_id() != thread_ || thread_seconds() >= next_thread_seconds_;
    return is_rested && Clock::now() >= next_;
  }

  /// Does the work, which is then due again after a while. `more` is processor time (s) that was spent for it
  /// elsewhere, and `processors` how many there are to take a fraction of.
  template<class Work> void spend(const Work& work, double more = 0.0, int processors = 1) {
    assert(more >= 0.0 && processors > 0);
    const Clock::time_point begin = Clock::now();
    const double before = thread_seconds();
    work();
    const double spent = (thread_seconds() - before + more) / processors;
    thread_ = std::this_thread::get_id();
    next_thread_seconds_ = before + spent / fraction_;
    next_ = begin + std::chrono::duration_cast<Clock::duration>(
                        std::chrono::duration<double>(std::max(interval_, spent / fraction_)));
  }

private:
  double interval_, fraction_;
  Of of_;
  Clock::time_point next_ = Clock::time_point::min();
  std::thread::id thread_; // that did the work last
  double next_thread_seconds_ = 0.0;
};

} // namespace keeler::live_view
