#include "self_force.hpp"

#include "spline_waves.hpp"

#include <keeler/core/units.hpp>

#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace keeler::gravity {
namespace {

// One axis at the wave numbers k = π (i + ½) / (points × spacing): the weight of a wave in the sums of the other axes,
// and in harmonics 1 and 2 of this axis.
struct Axis {
  static constexpr int points = 16;
  explicit Axis(double spacing) {
    assert(spacing > 0.0);
    const double step = pi / points;
    for (int i = 0; i < points; ++i) {
      const double angle = step * (i + 0.5), aliased = aliased_spline_squares(std::cos(angle));
      const double window = spline_transform(angle) * spline_transform(angle);
      k.push_back(angle / spacing);
      weight.push_back(window / aliased * step / (pi * spacing));
      for (int p = 1; p <= 2; ++p) {
        double sum = 0.0;
        for (int alias = -4; alias <= 4; ++alias) {
          const double from = angle + 2.0 * pi * alias, to = from + 2.0 * pi * p;
          // over −k too: a sum that is odd in k would vanish
          const double back = -angle + 2.0 * pi * alias, back_to = back + 2.0 * pi * p;
          sum += to * spline_transform(to) * spline_transform(from) +
                 back_to * spline_transform(back_to) * spline_transform(back);
        }
        harmonic[static_cast<std::size_t>(p - 1)].push_back(0.5 * sum / spacing / aliased);
      }
    }
  }
  std::vector<double> k, weight;
  std::array<std::vector<double>, 2> harmonic; // relative to weight
};

} // namespace

// u(x) = ∫ d³k/(2π)³ K(k) Σ_m' w(k_m') e^{i k_m' x} Σ_m w(k_m) e^{−i k_m x'} with K = 4π S/q² Π w²/A², A = Σ_m w²(k_m)
// on each axis: at x' = x the terms m' − m = ± p of ∂u/∂x make the harmonic p.
SelfForce self_force(const MeshShape& shape, const ForceSplit& split, double radius) {
  const Axis x(shape.step_x), y(shape.step_y), z(shape.step_z);
  std::array<std::array<double, 3>, 2> sums{};
  for (std::size_t a = 0; a < Axis::points; ++a)
    for (std::size_t b = 0; b < Axis::points; ++b)
      for (std::size_t c = 0; c < Axis::points; ++c) {
        const double q2 = x.k[a] * x.k[a] + y.k[b] * y.k[b] + z.k[c] * z.k[c];
        const double wave =
            4.0 * pi * split.transform(radius * std::sqrt(q2)) / q2 * x.weight[a] * y.weight[b] * z.weight[c];
        for (std::size_t p = 0; p < 2; ++p) {
          sums[p][0] += wave * x.harmonic[p][a];
          sums[p][1] += wave * y.harmonic[p][b];
          sums[p][2] += wave * z.harmonic[p][c];
        }
      }
  SelfForce force{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    force.first[axis] = static_cast<float>(-2.0 * sums[0][axis]);
    force.second[axis] = static_cast<float>(-2.0 * sums[1][axis]);
  }
  return force;
}

} // namespace keeler::gravity
