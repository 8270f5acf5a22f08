// Progress of work in several phases, each with a known amount of work in arbitrary units.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/core/stopwatch.hpp>

#include <algorithm>
#include <cassert>
#include <functional>

namespace keeler {

class PhaseProgress {
public:
  /// `report` may be empty.
  explicit PhaseProgress(std::function<void(const Progress&)> report) : report_(std::move(report)) {}

  /// Begins a phase. Precondition: work >= 0.
  void begin(std::string what, double work) {
    assert(work >= 0.0);
    what_ = std::move(what);
    work_ = work;
    done_ = 0.0;
    begun_s_ = watch_.elapsed();
  }

  /// Reports that `work` more has been done.
  void add(double work) {
    done_ += work;
    if (!report_)
      return;
    const double fraction = std::min(1.0, done_ / work_), elapsed = watch_.elapsed();
    report_({fraction, elapsed, (elapsed - begun_s_) * (1.0 / fraction - 1.0), what_});
  }

private:
  std::function<void(const Progress&)> report_;
  double total_ = 0.0;
  Stopwatch watch_{total_};
  std::string what_;
  double work_ = 1.0, done_ = 0.0, begun_s_ = 0.0;
};

} // namespace keeler
