#include <keeler/scene/scene.hpp>

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {

double DensityPattern::relative(double x, double y) const {
  assert(size_x > 0.0 && size_y > 0.0);
  if (uniform())
    return 1.0;
  const double step = x >= low && x < high ? factor : 1.0;
  const double phase = two_pi * (waves_x * x / size_x + waves_y * y / size_y);
  return step * (1.0 + contrast * std::cos(phase)) / mean();
}

double DensityPattern::peak() const {
  return uniform() ? 1.0 : std::max(1.0, factor) * (1.0 + contrast) / mean();
}

// Returns the mean of step × wave. A wave with waves_y ≠ 0 has no mean at any x; one along x weighs the step by
// ∫ cos(kx) dx.
double DensityPattern::mean() const {
  assert(low <= high && high - low <= size_x);
  double length = high - low;
  if (waves_y == 0 && waves_x != 0) {
    const double k = two_pi * waves_x / size_x;
    length += contrast * (std::sin(k * high) - std::sin(k * low)) / k;
  }
  return 1.0 + (factor - 1.0) * length / size_x;
}

double DensityPattern::wavelength() const {
  assert(waves_x != 0 || waves_y != 0);
  return 1.0 / std::hypot(waves_x / size_x, waves_y / size_y);
}

double DensityPattern::pitch() const {
  assert(waves_x != 0 || waves_y != 0);
  return std::atan2(waves_y / size_y, waves_x / size_x) * 180.0 / pi;
}

} // namespace keeler::scene
