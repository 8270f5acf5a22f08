#include "step_law.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

// Fits A and B for a given d by linear least squares of (A/h + B h^d)/T − 1. Returns the sum of squares.
double fit_at(double d, std::span<const double> h, std::span<const double> t, double& a, double& b) {
  double uu = 0.0, uv = 0.0, vv = 0.0, u1 = 0.0, v1 = 0.0;
  for (std::size_t k = 0; k < h.size(); ++k) {
    const double u = 1.0 / (h[k] * t[k]), v = std::pow(h[k], d) / t[k];
    uu += u * u, uv += u * v, vv += v * v, u1 += u, v1 += v;
  }
  const double determinant = uu * vv - uv * uv;
  a = (u1 * vv - v1 * uv) / determinant;
  b = (v1 * uu - u1 * uv) / determinant;
  if (!(b > 0.0))
    a = u1 / uu, b = 0.0;
  else if (!(a > 0.0))
    a = 0.0, b = v1 / vv;
  double squares = 0.0;
  for (std::size_t k = 0; k < h.size(); ++k) {
    const double error = (a / h[k] + b * std::pow(h[k], d)) / t[k] - 1.0;
    squares += error * error;
  }
  return squares;
}

} // namespace

StepLaw fit_step_law(std::span<const double> steps, std::span<const double> times) {
  assert(steps.size() == times.size() && steps.size() >= 3);
  StepLaw law;
  double smallest = HUGE_VAL;
  for (int k = 0; k <= 375; ++k) {
    const double d = 0.25 + 0.01 * k;
    double a = 0.0, b = 0.0;
    const double squares = fit_at(d, steps, times, a, b);
    if (squares < smallest) {
      smallest = squares;
      law.a = a, law.b = b, law.d = d;
    }
  }
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double fitted = law.a / steps[k] + law.b * std::pow(steps[k], law.d);
    law.largest_error = std::max(law.largest_error, std::fabs(fitted / times[k] - 1.0));
  }
  if (law.b > 0.0)
    law.best_step = std::pow(law.a / (law.b * law.d), 1.0 / (law.d + 1.0));
  return law;
}

} // namespace keeler::study
