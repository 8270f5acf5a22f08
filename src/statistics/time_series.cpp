#include <keeler/statistics/time_series.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace keeler::statistics {
namespace {

constexpr std::size_t batches = 256; // maximum number of bins of a series in steady_start()

double mean_of(std::span<const double> values) {
  assert(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Returns the error of the mean for independent values.
double plain_error(std::span<const double> values) {
  assert(values.size() > 1);
  const double mean = mean_of(values), n = static_cast<double>(values.size());
  double squares = 0.0;
  for (const double v : values)
    squares += (v - mean) * (v - mean);
  return std::sqrt(squares / (n * (n - 1.0)));
}

std::vector<double> blocks_of(std::span<const double> values, std::size_t length) {
  assert(length > 0);
  std::vector<double> blocks;
  for (std::size_t k = 0; k + length <= values.size(); k += length)
    blocks.push_back(mean_of(values.subspan(k, length)));
  return blocks;
}

} // namespace

Estimate block_mean(std::span<const double> values) {
  assert(!values.empty());
  constexpr std::size_t min_blocks = 4;
  Estimate mean{mean_of(values), std::numeric_limits<double>::quiet_NaN()};
  if (values.size() < min_blocks)
    return mean;
  const double independent = plain_error(values);
  mean.error = independent;
  if (independent == 0.0)
    return mean;
  for (std::size_t length = 1; values.size() / length >= min_blocks; length *= 2) {
    const double error = plain_error(blocks_of(values, length)), b = static_cast<double>(length);
    mean.error = std::max(mean.error, error);
    if (b * b * b > 2.0 * static_cast<double>(values.size()) * std::pow(error / independent, 4.0)) {
      mean.error = error;
      break;
    }
  }
  return mean;
}

double statistical_inefficiency(std::span<const double> values) {
  const std::size_t n = values.size();
  if (n < 4)
    return 1.0;
  const double mean = mean_of(values);
  const auto product = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t k = 0; k + lag < n; ++k)
      sum += (values[k] - mean) * (values[k + lag] - mean);
    return sum / static_cast<double>(n - lag);
  };
  const double variance = product(0);
  double g = 1.0;
  for (std::size_t lag = 1; variance > 0.0 && lag + 1 < n; ++lag) {
    const double correlation = product(lag) / variance;
    if (correlation <= 0.0)
      break;
    g += 2.0 * correlation * (1.0 - static_cast<double>(lag) / static_cast<double>(n));
  }
  return g;
}

std::size_t steady_start(std::span<const double> values) {
  const std::size_t length = (values.size() + batches - 1) / batches;
  const std::vector<double> coarse = blocks_of(values, std::max<std::size_t>(length, 1));
  std::size_t best = 0;
  double max_independent = 0.0;
  // The correlations of a short rest are uncertain and underestimated, so at least a third must be left.
  for (std::size_t start = 0; start + 4 <= coarse.size() && 3 * start <= 2 * coarse.size(); ++start) {
    const std::span<const double> rest(coarse.data() + start, coarse.size() - start);
    const double independent = static_cast<double>(rest.size()) / statistical_inefficiency(rest);
    if (independent > max_independent) {
      max_independent = independent;
      best = start;
    }
  }
  return best * length;
}

bool is_steady(std::span<const double> values) {
  if (values.size() < 8)
    return false;
  constexpr double max_sigmas = 3.0;
  const std::size_t half = values.size() / 2, start = steady_start(values);
  const Estimate first = block_mean(values.first(half)), last = block_mean(values.last(half));
  if (!(std::fabs(last.value - first.value) <= max_sigmas * std::hypot(first.error, last.error)))
    return false;
  if (3 * start <= values.size())
    return true;
  // A late start may be chance. Then the mean before it agrees with the mean after it, within the error of the latter.
  const double before = static_cast<double>(start), after = static_cast<double>(values.size() - start);
  const Estimate rest = block_mean(values.subspan(start));
  return std::fabs(mean_of(values.first(start)) - rest.value) <=
         max_sigmas * rest.error * std::sqrt(1.0 + after / before);
}

} // namespace keeler::statistics
