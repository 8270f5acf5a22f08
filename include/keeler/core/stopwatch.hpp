// Wall time spent in a scope, and the processor time of this process.
#pragma once

#include <chrono>
#include <ctime>

namespace keeler {

/// Adds the seconds between its construction and its end to a total.
class Stopwatch {
public:
  explicit Stopwatch(double& total) : total_(total) {}
  ~Stopwatch() { total_ += elapsed(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  double elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
  double& total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Processor seconds that all threads of this process have used.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace keeler
