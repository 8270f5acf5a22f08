#include "wave_kernel.hpp"

#include "spline_waves.hpp"

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr std::size_t k_steps = 1024, window_steps = 1024;
constexpr std::size_t farthest_reach = 24;
constexpr int block = 8; // waves at a time

double power(double value, int exponent) {
  double result = 1.0;
  for (int i = 0; i < exponent; ++i)
    result *= value;
  return result;
}

double window_squared(double angle) {
  const double window = spline_transform(angle);
  return window * window;
}

// 2π/k ω e^{−k |j|} is the tail far away, ω for what spreading and interpolation do to e^{± k z}.
double tail_factor(double k) {
  const double shape = k == 0.0 ? 1.0 : power(std::sinh(0.5 * k) / (0.5 * k), 8);
  const double aliased = aliased_spline_squares(std::cosh(k));
  return 2.0 * pi * shape / (aliased * aliased);
}

// k / 2π ω times the sum of ω (2π/k) e^{−k |j|} e^{−i j angle} over all planes j.
double tail_transform(double k, double angle) {
  if (k == 0.0)
    return 1.0 / (1.0 - std::cos(angle));
  return std::sinh(k) / k / (std::cosh(k) - std::cos(angle));
}

} // namespace

WaveKernel::WaveKernel(const ForceSplit& split, double radius, double highest_k) : highest_k_(highest_k) {
  for (std::size_t i = 0; i <= window_steps + 1; ++i) {
    const double turn = pi * static_cast<double>(i) / static_cast<double>(window_steps);
    const double aliased = aliased_spline_squares(std::cos(turn));
    window_.push_back(static_cast<float>(window_squared(turn) / (aliased * aliased)));
  }
  tabulate(split, radius);
}

// The coefficients at planes j = 0, 1 … are those of the transform along z minus the tail's. Half-way sample angles
// avoid the pole of both at 0.
void WaveKernel::tabulate(const ForceSplit& split, double radius) {
  constexpr std::size_t samples = 2 * farthest_reach;
  std::vector<double> near((k_steps + 2) * (farthest_reach + 1), 0.0);
  std::vector<double> cosines, windows, aliased;
  for (std::size_t n = 0; n < samples; ++n) {
    const double angle = pi * (static_cast<double>(n) + 0.5) / static_cast<double>(samples);
    for (std::size_t j = 0; j <= farthest_reach; ++j)
      cosines.push_back(std::cos(angle * static_cast<double>(j)));
    for (const int alias : {-1, 0, 1})
      windows.push_back(window_squared(angle + 2.0 * pi * alias));
    aliased.push_back(power(aliased_spline_squares(std::cos(angle)), 2));
  }
  for (std::size_t i = 0; i < k_steps + 2; ++i) {
    const double k = highest_k_ * static_cast<double>(i) / static_cast<double>(k_steps);
    for (std::size_t n = 0; n < samples; ++n) {
      const double angle = pi * (static_cast<double>(n) + 0.5) / static_cast<double>(samples);
      double whole = 0.0;
      for (const int alias : {-1, 0, 1}) {
        const double k_z = angle + 2.0 * pi * alias, q2 = k * k + k_z * k_z;
        whole += windows[3 * n + static_cast<std::size_t>(alias + 1)] * split.transform(radius * std::sqrt(q2)) / q2;
      }
      const double rest = 4.0 * pi * whole / aliased[n] - tail_factor(k) * tail_transform(k, angle);
      for (std::size_t j = 0; j <= farthest_reach; ++j)
        near[i * (farthest_reach + 1) + j] += rest * cosines[n * (farthest_reach + 1) + j] / samples;
    }
  }
  // planes farther out than this matter less than rounding in single precision does
  for (std::size_t i = 0; i < k_steps + 2; ++i)
    for (std::size_t j = reach_ + 1; j <= farthest_reach; ++j)
      if (std::fabs(near[i * (farthest_reach + 1) + j]) > 1e-6)
        reach_ = j;
  for (std::size_t i = 0; i < k_steps + 2; ++i) {
    const auto begin = near.begin() + static_cast<std::ptrdiff_t>(i * (farthest_reach + 1));
    for (std::size_t j = 0; j <= reach_; ++j)
      table_.push_back(static_cast<float>(begin[static_cast<std::ptrdiff_t>(j)]));
    table_.push_back(static_cast<float>(tail_factor(highest_k_ * static_cast<double>(i) / static_cast<double>(k_steps))));
  }
}

void WaveKernel::apply(const MeshShape& shape, const ShearedTransform& transform, std::size_t m,
                       const MeshKernels& kernels, const std::complex<float>* from, std::complex<float>* to) const {
  const std::size_t row = transform.row_length(), planes = shape.planes, entries = reach_ + 2;
  const double per_turn_x = 2.0 * pi / static_cast<double>(shape.columns); // angle a column of one turn along the box
  const double per_turn_y = 2.0 * pi / static_cast<double>(shape.rows);
  const auto window = [&](double angle) {
    const double place = std::fabs(angle) / pi * static_cast<double>(window_steps);
    const auto i = std::min(static_cast<std::size_t>(place), window_steps);
    return window_[i] + static_cast<float>(place - static_cast<double>(i)) * (window_[i + 1] - window_[i]);
  };
  const double angle_y = per_turn_y * static_cast<double>(m), k_y = angle_y * shape.step_z / shape.step_y;
  const double area = shape.step_x * shape.step_y * static_cast<double>(shape.columns * shape.rows);
  const auto scale = static_cast<float>(shape.step_z / area * static_cast<double>(window(angle_y)));

  AlignedArray<float> factors, padded;
  factors.resize_at_least(16 * (reach_ + 3));
  padded.resize_at_least(16 * (planes + 2 * reach_ + 2));
  float* const near = factors.data();
  float* const far = near + 16 * (reach_ + 1);
  float* const decay = far + 16;
  float* const inner = padded.data() + 16 * (reach_ + 1);
  std::fill(padded.data(), inner, 0.0f);
  std::fill(inner + 16 * planes, inner + 16 * (planes + reach_ + 1), 0.0f);

  for (std::size_t begin = 0; begin < shape.columns; begin += block) {
    for (std::size_t c = 0; c < block; ++c) {
      const double angle_x = begin + c < shape.columns ? per_turn_x * transform.turns_x(m, begin + c) : pi;
      const double k_x = angle_x * shape.step_z / shape.step_x, k = std::sqrt(k_x * k_x + k_y * k_y);
      const double place = k / highest_k_ * static_cast<double>(k_steps);
      const auto i = std::min(static_cast<std::size_t>(place), k_steps);
      const bool held = place <= static_cast<double>(k_steps);
      const auto part = static_cast<float>(place - static_cast<double>(i));
      const float* const a = table_.data() + i * entries;
      const float* const b = a + entries;
      const float factor = held ? scale * window(angle_x) : 0.0f;
      for (std::size_t j = 0; j <= reach_; ++j)
        near[16 * j + 2 * c] = near[16 * j + 2 * c + 1] = factor * (a[j] + part * (b[j] - a[j]));
      const float tail = a[reach_ + 1] + part * (b[reach_ + 1] - a[reach_ + 1]);
      const float far_factor = k > 0.0 ? factor * tail / static_cast<float>(k) : 0.0f;
      far[2 * c] = far[2 * c + 1] = far_factor;
      near[2 * c] += far_factor;
      near[2 * c + 1] += far_factor;
      decay[2 * c] = decay[2 * c + 1] = static_cast<float>(std::exp(-k));
    }
    for (std::size_t p = 0; p < planes; ++p) {
      const auto* const numbers = reinterpret_cast<const float*>(from + p * row + begin);
      std::copy(numbers, numbers + 16, inner + 16 * p);
    }
    kernels.convolve(inner, planes, near, reach_, far, decay, reinterpret_cast<float*>(to + begin), 2 * row);
  }
  if (m == 0) { // the tail of the wave 0, −2π |Δz|, which has no other wave's form; from both sides, in double
    double below = 0.0, moment = 0.0;
    std::vector<double> sums(planes, 0.0);
    for (std::size_t p = 0; p < planes; ++p) {
      moment += below;
      below += static_cast<double>(from[p * row].real());
      sums[p] += moment;
    }
    below = moment = 0.0;
    for (std::size_t p = planes; p-- > 0;) {
      moment += below;
      below += static_cast<double>(from[p * row].real());
      sums[p] += moment;
    }
    for (std::size_t p = 0; p < planes; ++p)
      to[p * row] -= static_cast<float>(2.0 * pi * shape.step_z / area * (sums[p] - sums[planes / 2]));
  }
}

} // namespace keeler
