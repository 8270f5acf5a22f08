#include "wave_kernel.hpp"

#include "spline_waves.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::gravity {
namespace {

constexpr std::size_t k_steps = 1024, window_steps = 1024;

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

// Returns 2π ω, where 2π/k ω e^{−k |j|} is the tail at distant planes j and ω the effect of spreading and interpolation
// on e^{± k z}.
double tail_factor(double k) {
  const double shape = k == 0.0 ? 1.0 : power(std::sinh(0.5 * k) / (0.5 * k), 8);
  const double aliased = aliased_spline_squares(std::cosh(k));
  return 2.0 * pi * shape / (aliased * aliased);
}

// Returns the sum of e^{−k |j|} e^{−i j angle} / k over all planes j; for k = 0 that of −|j| e^{−i j angle}.
double tail_transform(double k, double angle) {
  if (k == 0.0)
    return 1.0 / (1.0 - std::cos(angle));
  return std::sinh(k) / k / (std::cosh(k) - std::cos(angle));
}

// Adds the tail of the wave k = 0, −2π |Δz|, from both sides and in double: its factors are not exponentials.
void add_sheets(const MeshShape& shape, std::size_t row, const std::complex<float>* from, std::complex<float>* to) {
  const auto unit = static_cast<double>(2.0 * pi * shape.step_z / shape.area());
  double mass = 0.0, moment = 0.0;
  for (std::size_t p = 0; p < shape.planes; ++p) {
    moment += mass;
    mass += static_cast<double>(from[p * row].real());
    to[p * row] -= static_cast<float>(unit * moment);
  }
  mass = moment = 0.0;
  for (std::size_t p = shape.planes; p-- > 0;) {
    moment += mass;
    mass += static_cast<double>(from[p * row].real());
    to[p * row] -= static_cast<float>(unit * moment);
  }
}

} // namespace

WaveKernel::WaveKernel(const ForceSplit& split, double radius, double max_k) : max_k_(max_k) {
  assert(radius > 0.0 && max_k > 0.0);
  for (std::size_t i = 0; i <= window_steps + 1; ++i) {
    const double angle = pi * static_cast<double>(i) / static_cast<double>(window_steps);
    const double aliased = aliased_spline_squares(std::cos(angle));
    window_.push_back(static_cast<float>(window_squared(angle) / (aliased * aliased)));
  }
  tabulate(split, radius);
}

// Tabulates the coefficients at planes j = 0, 1 …: the inverse transform along z of the kernel minus the tail. Sample
// angles at half steps avoid the pole of both at 0.
void WaveKernel::tabulate(const ForceSplit& split, double radius) {
  const auto max_reach = static_cast<std::size_t>(radius) + 12; // beyond the cloud the rest decays within some planes
  const std::size_t samples = 2 * max_reach;
  std::vector<double> near((k_steps + 2) * (max_reach + 1), 0.0);
  std::vector<double> cosines, windows, aliased;
  for (std::size_t n = 0; n < samples; ++n) {
    const double angle = pi * (static_cast<double>(n) + 0.5) / static_cast<double>(samples);
    for (std::size_t j = 0; j <= max_reach; ++j)
      cosines.push_back(std::cos(angle * static_cast<double>(j)));
    for (const int alias : {-1, 0, 1})
      windows.push_back(window_squared(angle + 2.0 * pi * alias));
    aliased.push_back(power(aliased_spline_squares(std::cos(angle)), 2));
  }
  for (std::size_t i = 0; i < k_steps + 2; ++i) {
    const double k = max_k_ * static_cast<double>(i) / static_cast<double>(k_steps);
    for (std::size_t n = 0; n < samples; ++n) {
      const double angle = pi * (static_cast<double>(n) + 0.5) / static_cast<double>(samples);
      double whole = 0.0;
      for (const int alias : {-1, 0, 1}) {
        const double k_z = angle + 2.0 * pi * alias, q2 = k * k + k_z * k_z;
        whole += windows[3 * n + static_cast<std::size_t>(alias + 1)] * split.transform(radius * std::sqrt(q2)) / q2;
      }
      const double rest = 4.0 * pi * whole / aliased[n] - tail_factor(k) * tail_transform(k, angle);
      for (std::size_t j = 0; j <= max_reach; ++j)
        near[i * (max_reach + 1) + j] += rest * cosines[n * (max_reach + 1) + j] / static_cast<double>(samples);
    }
  }
  // contributions of planes beyond are below rounding in single precision
  for (std::size_t i = 0; i < k_steps + 2; ++i)
    for (std::size_t j = reach_ + 1; j <= max_reach; ++j)
      if (std::fabs(near[i * (max_reach + 1) + j]) > 1e-6)
        reach_ = j;
  for (std::size_t i = 0; i < k_steps + 2; ++i) {
    const auto begin = near.begin() + static_cast<std::ptrdiff_t>(i * (max_reach + 1));
    for (std::size_t j = 0; j <= reach_; ++j)
      table_.push_back(static_cast<float>(begin[static_cast<std::ptrdiff_t>(j)]));
    table_.push_back(static_cast<float>(tail_factor(max_k_ * static_cast<double>(i) / static_cast<double>(k_steps))));
  }
}

void WaveKernel::prepare(const MeshShape& shape) {
  assert(shape.planes > 0);
  scratch_.resize(static_cast<std::size_t>(threads()));
  for (auto& scratch : scratch_)
    scratch.resize_at_least(16 * (shape.planes + 3 * reach_ + 5));
}

float WaveKernel::window(double angle) const {
  const double position = std::fabs(angle) / pi * static_cast<double>(window_steps);
  const auto i = std::min(static_cast<std::size_t>(position), window_steps);
  return window_[i] + static_cast<float>(position - static_cast<double>(i)) * (window_[i + 1] - window_[i]);
}

// Interpolates the factors of columns [begin, begin + block) of wave m in the tables.
void WaveKernel::factors_of_block(const MeshShape& shape, const ShearedTransform& transform, std::size_t m,
                                  std::size_t begin, const Factors& factors) const {
  const double step_x = 2.0 * pi / static_cast<double>(shape.columns); // angle per column of the box's longest wave
  const double angle_y = 2.0 * pi / static_cast<double>(shape.rows) * static_cast<double>(m);
  const double k_y = angle_y * shape.step_z / shape.step_y;
  const auto scale = static_cast<float>(shape.step_z / shape.area()) * window(angle_y);
  for (std::size_t c = 0; c < block; ++c) {
    const double angle_x = step_x * transform.relative_kx(m, std::min(begin + c, shape.columns - 1));
    const double k_x = angle_x * shape.step_z / shape.step_x, k = std::sqrt(k_x * k_x + k_y * k_y);
    const double position = k / max_k_ * static_cast<double>(k_steps);
    const auto i = std::min(static_cast<std::size_t>(position), k_steps);
    const auto fraction = static_cast<float>(position - static_cast<double>(i));
    const float factor = position <= static_cast<double>(k_steps) ? scale * window(angle_x) : 0.0f;
    const float* const entry = table_.data() + i * (reach_ + 2);
    const float* const next = entry + reach_ + 2;
    const auto between = [&](std::size_t j) { return entry[j] + fraction * (next[j] - entry[j]); };
    const float tail = k > 0.0 ? factor * between(reach_ + 1) / static_cast<float>(k) : 0.0f;
    const auto decay = static_cast<float>(std::exp(-k));
    for (const std::size_t number : {2 * c, 2 * c + 1}) { // the real and the imaginary part
      for (std::size_t j = 0; j <= reach_; ++j)
        factors.near[16 * j + number] = factor * between(j);
      factors.near[number] += tail;
      factors.far[number] = tail;
      factors.decay[number] = decay;
    }
  }
}

void WaveKernel::apply(const MeshShape& shape, const ShearedTransform& transform, std::size_t m,
                       const MeshKernels& kernels, const std::complex<float>* from, std::complex<float>* to) {
  const std::size_t row = transform.row_length(), planes = shape.planes;
  float* const scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())].data();
  const Factors factors{scratch, scratch + 16 * (reach_ + 1), scratch + 16 * (reach_ + 2)};
  float* const padding = scratch + 16 * (reach_ + 3);
  float* const inner = padding + 16 * (reach_ + 1);
  std::fill(padding, inner, 0.0f);
  std::fill(inner + 16 * planes, inner + 16 * (planes + reach_ + 1), 0.0f);
  for (std::size_t begin = 0; begin < shape.columns; begin += block) {
    factors_of_block(shape, transform, m, begin, factors);
    for (std::size_t p = 0; p < planes; ++p) {
      const auto* const numbers = reinterpret_cast<const float*>(from + p * row + begin);
      std::copy(numbers, numbers + 16, inner + 16 * p);
    }
    kernels.convolve(inner, planes, factors.near, reach_, factors.far, factors.decay,
                     reinterpret_cast<float*>(to + begin), 2 * row);
  }
  if (m == 0)
    add_sheets(shape, row, from, to);
}

} // namespace keeler::gravity
