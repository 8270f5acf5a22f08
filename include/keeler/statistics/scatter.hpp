// Whether two samples of a scattering number differ by more than their scatter explains.
#pragma once

#include <cmath>
#include <vector>

namespace keeler {

struct Scatter {
  std::size_t count = 0;
  double mean = 0.0;      ///< NaN of nothing
  double deviation = 0.0; ///< standard deviation of one value, n − 1 in its denominator; NaN of fewer than two

  double mean_error() const {
    return deviation / std::sqrt(static_cast<double>(count));
  } ///< standard error of the mean
};

Scatter scatter_of(const std::vector<double>& values);

/// Half the width of the interval about the mean that holds the true one in 95 % of all cases, by Student's t. NaN of
/// fewer than two values.
double mean_bound(const Scatter& scatter);

/// Student's t for two samples of the same variance. Equal means differ by less than the bound in 95 % of all cases.
/// NaN when either sample has fewer than two values.
struct MeanDifference {
  double difference = 0.0; ///< of the means, second − first
  double bound = 0.0;

  bool known() const { return !std::isnan(bound); }
  bool within() const { return std::fabs(difference) <= bound; }
};

MeanDifference mean_difference(const Scatter& first, const Scatter& second);

} // namespace keeler
