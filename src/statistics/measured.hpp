// A number measured on several snapshots, and the scatter of the single snapshots.
#pragma once

#include <optional>
#include <span>

namespace keeler {

struct Measured {
  std::optional<double> value;   ///< of all snapshots together; none if it cannot be measured
  std::optional<double> scatter; ///< standard deviation of single snapshots about their mean; none if fewer than two
};

/// Returns `value` and the scatter of `singles`, the values of the snapshots that have one.
Measured measured(std::optional<double> value, std::span<const double> singles);

/// As measured(), for directions of lines (degrees), which are equivalent modulo 180°: single values are shifted to
/// within 90° of `value`.
Measured measured_direction(std::optional<double> value, std::span<const double> singles);

} // namespace keeler
