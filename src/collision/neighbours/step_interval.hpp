// Consecutive steps of equal length for which something stays valid: lists, or pruned pairs.
#pragma once

#include "line.hpp"

#include <cassert>

namespace keeler::collision {

struct StepInterval {
  int age = 0;    ///< number of the present step, from 0 on
  int length = 1; ///< steps

  bool over() const { return age >= length; }
  int rest() const { return length - age; } ///< steps from the begin of the present one on

  /// Half the interval, rad; `step` is the length of a step.
  double half(double step) const { return 0.5 * length * step; }
  double half_rest(double step) const { return 0.5 * (length - age) * step; }

  /// Time from the middle of the interval to the epoch of the present step, rad.
  double since_middle(double step) const { return (age + 0.5 - 0.5 * length) * step; }
  /// Time from that epoch to the middle of the rest, rad.
  double to_middle_of_rest(double step) const { return 0.5 * (length - age - 1) * step; }
};

/// Returns [begin, end] in single precision, widened by what that does to times of up to `half`.
inline LineSpan widened(double begin, double end, double half) {
  assert(begin <= end);
  return {static_cast<float>(begin - 1e-6 * half), static_cast<float>(end + 1e-6 * half)};
}

} // namespace keeler::collision
