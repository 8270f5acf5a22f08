#include "force_split.hpp"

#include <keeler/core/linear_algebra.hpp>
#include <keeler/core/units.hpp>

#include <cassert>
#include <cmath>

namespace keeler::gravity {
namespace {

constexpr auto term_count = static_cast<Eigen::Index>(ForceSplit::terms);
constexpr double fineness = 64.0, last_sample = 48.0;

using Coefficients = Eigen::Matrix<double, term_count, 1>;

// Nodes and weights of the Gauss–Legendre rule on [0, 1], by Newton's iteration on P_n.
struct Quadrature {
  explicit Quadrature(int n) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 0.0;
      for (int iteration = 0; iteration < 8; ++iteration) {
        double last = 1.0, here = x;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * x * here - (k - 1) * last) / k;
          last = here;
          here = next;
        }
        slope = n * (x * here - last) / (x * x - 1.0);
        x -= here / slope;
      }
      nodes.push_back(0.5 * (1.0 + x));
      weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
  }
  std::vector<double> nodes, weights;
};

// Returns (1 − u²) u^2i for each i.
Coefficients basis(double u) {
  Coefficients values;
  double value = 1.0 - u * u;
  for (Eigen::Index i = 0; i < term_count; ++i, value *= u * u)
    values[i] = value;
  return values;
}

// Returns the profile ψ with the largest fraction of its power below the band; ∫₀¹ ψ = 1.
Coefficients most_concentrated(const Quadrature& rule, double band) {
  assert(band > 0.0);
  using Matrix = Eigen::Matrix<double, term_count, term_count>;
  Matrix below = Matrix::Zero(), whole = Matrix::Zero();
  Coefficients integral = Coefficients::Zero();
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const Coefficients at_u = basis(rule.nodes[i]);
    whole += rule.weights[i] * at_u * at_u.transpose();
    integral += rule.weights[i] * at_u;
    Coefficients wave = Coefficients::Zero();
    for (std::size_t j = 0; j < rule.nodes.size(); ++j)
      wave += rule.weights[j] * std::cos(band * rule.nodes[i] * rule.nodes[j]) * basis(rule.nodes[j]);
    below += rule.weights[i] * wave * wave.transpose();
  }
  const Coefficients best = last_eigenvector(below, whole);
  return best / best.dot(integral);
}

} // namespace

// The potential of the cloud is Φ(u)/u with Φ(u) = ∫₀ᵘ ψ, and its attraction (Φ − u ψ)/u³ times the vector.
ForceSplit::ForceSplit(double band) {
  const Quadrature rule(40);
  const Coefficients profile = most_concentrated(rule, band);
  for (Eigen::Index j = 1; j <= term_count; ++j) {
    const double power = (j < term_count ? profile[j] : 0.0) - profile[j - 1]; // of u^2j in ψ
    inside_[static_cast<std::size_t>(j - 1)] = -power * static_cast<double>(2 * j) / static_cast<double>(2 * j + 1);
  }
  for (int k = 0; k <= static_cast<int>(last_sample * fineness) + 1; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      sum += rule.weights[i] * std::cos(k / fineness * rule.nodes[i]) * profile.dot(basis(rule.nodes[i]));
    samples_.push_back(sum);
  }
}

std::array<double, ForceSplit::terms + 1> ForceSplit::potential() const {
  std::array<double, terms + 1> q{1.0};
  for (std::size_t j = 0; j < terms; ++j) {
    const double part = inside_[j] / static_cast<double>(2 * j + 2);
    q[0] += part;
    q[j + 1] = -part;
  }
  return q;
}

double ForceSplit::transform(double wave_number) const {
  assert(wave_number >= 0.0);
  if (wave_number >= last_sample)
    return 0.0;
  const double position = wave_number * fineness;
  const auto k = static_cast<std::size_t>(position);
  const double fraction = position - static_cast<double>(k);
  return samples_[k] + fraction * (samples_[k + 1] - samples_[k]);
}

} // namespace keeler::gravity
