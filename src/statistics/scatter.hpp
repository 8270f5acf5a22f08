// Mean and scatter of a sample, and the comparison of the means of two samples.
#pragma once

#include <cmath>
#include <vector>

namespace keeler::statistics {

struct Scatter {
  std::size_t count = 0;
  double mean = 0.0;      ///< NaN if count is 0
  double deviation = 0.0; ///< standard deviation of one value, with n − 1; NaN if count < 2

  /// Returns the standard error of the mean.
  double mean_error() const { return deviation / std::sqrt(static_cast<double>(count)); }
};

/// Returns the mean and the standard deviation of values.
Scatter scatter_of(const std::vector<double>& values);

/// Returns half the width of the 95 % confidence interval of the mean, by Student's t; NaN for fewer than two values.
double mean_bound(const Scatter& scatter);

/// Student's t test for two samples of equal variance. If their true means are equal, the difference is below the bound
/// in 95 % of all cases.
struct MeanDifference {
  double difference = 0.0; ///< of the means, second − first
  double bound = 0.0;      ///< NaN if either sample has fewer than two values

  bool known() const { return !std::isnan(bound); }
  bool within() const { return std::fabs(difference) <= bound; }
};

MeanDifference mean_difference(const Scatter& first, const Scatter& second);

} // namespace keeler::statistics
