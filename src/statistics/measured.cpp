#include <keeler/statistics/measured.hpp>

#include <keeler/statistics/scatter.hpp>

#include <cmath>

namespace keeler::statistics {

Measured measured(std::optional<double> value, std::span<const double> singles) {
  Measured result;
  result.value = value;
  if (value && singles.size() > 1)
    result.scatter = scatter_of({singles.begin(), singles.end()}).deviation;
  return result;
}

Measured measured_direction(std::optional<double> value, std::span<const double> singles) {
  std::vector<double> near(singles.begin(), singles.end());
  for (double& angle : near)
    angle -= 180.0 * std::round((angle - value.value_or(angle)) / 180.0);
  return measured(value, near);
}

} // namespace keeler::statistics
