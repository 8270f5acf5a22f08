#include <keeler/statistics/scatter.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace keeler::statistics {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// 95 % quantiles of |t|, for 1, 2, … degrees of freedom. Beyond the table the last one is used, a little too large.
constexpr std::array<double, 20> student_95 = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                               2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086};

double student(std::size_t degrees) {
  assert(degrees > 0);
  return student_95[std::min(degrees, student_95.size()) - 1];
}

} // namespace

Scatter scatter_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Scatter s{values.size(), unknown, unknown};
  if (values.empty())
    return s;
  s.mean = 0.0;
  for (const double value : values)
    s.mean += value / n;
  if (values.size() < 2)
    return s;
  double squares = 0.0;
  for (const double value : values)
    squares += (value - s.mean) * (value - s.mean);
  s.deviation = std::sqrt(squares / (n - 1.0));
  return s;
}

double mean_bound(const Scatter& scatter) {
  if (scatter.count < 2)
    return unknown;
  return student(scatter.count - 1) * scatter.mean_error();
}

MeanDifference mean_difference(const Scatter& first, const Scatter& second) {
  MeanDifference d{second.mean - first.mean, unknown};
  if (first.count < 2 || second.count < 2)
    return d;
  const double n = static_cast<double>(first.count), m = static_cast<double>(second.count);
  const double variance =
      ((n - 1.0) * first.deviation * first.deviation + (m - 1.0) * second.deviation * second.deviation) / (n + m - 2.0);
  const double t = student(first.count + second.count - 2);
  d.bound = t * std::sqrt(variance * (1.0 / n + 1.0 / m));
  return d;
}

} // namespace keeler::statistics
