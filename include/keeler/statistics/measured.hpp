// A number measured on several snapshots, and how far single snapshots scatter about it.
#pragma once

#include <optional>
#include <span>

namespace keeler {

struct Measured {
  std::optional<double> value;   ///< of all snapshots together; none where there is nothing to measure
  std::optional<double> scatter; ///< standard deviation of single snapshots about their mean; none of fewer than two
};

/// `singles` holds the values of the snapshots that have one.
Measured measured(std::optional<double> value, std::span<const double> singles);

/// The same for the directions of lines (degrees), which are the same after half a turn: values are taken within 90° of
/// `value`.
Measured measured_direction(std::optional<double> value, std::span<const double> singles);

} // namespace keeler
