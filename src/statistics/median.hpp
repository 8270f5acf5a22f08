// The median of repeated measurements.
#pragma once

#include <algorithm>
#include <cassert>
#include <vector>

namespace keeler::statistics {

/// Returns the middle value, or the mean of the two middle ones. Precondition: `values` is not empty.
inline double median(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

} // namespace keeler::statistics
