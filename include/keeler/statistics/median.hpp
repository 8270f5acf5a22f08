// The middle of repeated measurements.
#pragma once

#include <algorithm>
#include <vector>

namespace keeler {

/// The middle value, or the mean of the two middle ones. At least one value.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

} // namespace keeler
