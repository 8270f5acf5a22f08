// Measured numbers: a mean and its error, or a number of several snapshots and the scatter of single ones.
#pragma once

#include <optional>
#include <span>

namespace keeler::statistics {

/// A mean and its standard error.
struct Estimate {
  double value = 0.0; ///< the mean
  double error = 0.0; ///< NaN if there are too few values
};

/// A number measured on several snapshots.
struct Measured {
  std::optional<double> value;   ///< of all snapshots together; none if it cannot be measured
  std::optional<double> scatter; ///< standard deviation of single snapshots about their mean; none if fewer than two
};

/// Returns `value` and the scatter of `singles`, the values of the snapshots that have one.
Measured measured(std::optional<double> value, std::span<const double> singles);

/// As measured(), for directions of lines (degrees), which are equivalent modulo 180°: single values are shifted to
/// within 90° of `value`.
Measured measured_direction(std::optional<double> value, std::span<const double> singles);

} // namespace keeler::statistics

namespace keeler {
using statistics::Estimate;
} // namespace keeler
