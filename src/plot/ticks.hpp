// Ranges of axes and the round numbers at which they have ticks.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace keeler::plot {

/// Returns the largest of 1, 2 and 5 times powers of ten that is at most `value` > 0; round_above(): the smallest that
/// is at least `value`.
double round_below(double value);
double round_above(double value);

struct AxisRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  bool empty() const { return low > high; }
  void include(double value);
  /// Returns the range with a margin for the frame of a plot. A linear range of positive numbers begins at 0 if that
  /// is near. Preconditions: not empty; positive if `log`.
  AxisRange with_margin(bool log) const;
};

struct Tick {
  double value = 0.0;
  std::string label; ///< as for Page::text(); empty for a minor tick
};

/// Returns rising ticks within a range, with room for `most` steps between labels: round numbers on a linear axis; on a
/// logarithmic one powers of ten, or 1, 2 and 5 times them in a range of less than two decades. Preconditions:
/// low < high; 0 < low if `log`; most > 0.
std::vector<Tick> ticks_of(const AxisRange& range, bool log, double most);

} // namespace keeler::plot
