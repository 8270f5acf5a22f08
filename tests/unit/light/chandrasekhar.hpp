// Chandrasekhar's X and Y functions for isotropic scattering (Radiative Transfer, 1950, ch. VIII), by their equations
// in the optical depth t (§50): ∂X/∂t = Y(μ) k, ∂Y/∂t = −Y(μ)/μ + X(μ) k, k = (ϖ/2) ∫ Y(μ') dμ'/μ', from X = 1, Y =
// e^{−t/μ} at t → 0.
#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace keeler::test {

class IsotropicLayer {
public:
  IsotropicLayer(double albedo, double depth, const std::vector<double>& cosines) : albedo_(albedo) {
    // Nodes of ∫ f dμ/μ = ∫ f 2 du/u, μ = u²: Gauss–Legendre on pieces of u; then the asked cosines, without weight.
    constexpr std::array<double, 4> x = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                         0.8611363115940526};
    constexpr std::array<double, 4> w = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
    double high = 1.0;
    for (int piece = 0; piece < 24; ++piece) {
      const double low = 0.6 * high;
      for (std::size_t k = 0; k < 4; ++k) {
        const double u = 0.5 * (low + high) + 0.5 * (high - low) * x[k];
        mu_.push_back(u * u);
        weight_.push_back(0.5 * (high - low) * w[k] * 2.0 / u); // of dμ/μ
      }
      high = low;
    }
    for (const double mu : cosines) {
      mu_.push_back(mu);
      weight_.push_back(0.0);
    }
    double t = 1e-9;
    X.assign(mu_.size(), 1.0);
    for (const double mu : mu_)
      Y.push_back(std::exp(-t / mu));
    while (t < depth) {
      const double h = std::min({0.02 * t, 0.005, depth - t});
      step(h);
      t += h;
    }
  }

  /// Returns I/F of reflected light at the asked cosines number i (out) and j (in).
  double reflected(std::size_t i, std::size_t j) const {
    const std::size_t a = first() + i, b = first() + j;
    return 0.25 * albedo_ * mu_[b] / (mu_[a] + mu_[b]) * (X[a] * X[b] - Y[a] * Y[b]);
  }

  /// Returns I/F of transmitted, scattered light. Precondition: the cosines differ.
  double transmitted(std::size_t i, std::size_t j) const {
    const std::size_t a = first() + i, b = first() + j;
    return 0.25 * albedo_ * mu_[b] / (mu_[a] - mu_[b]) * (Y[a] * X[b] - X[a] * Y[b]);
  }

  /// Returns the part of the light at the cosine number j that leaves the layer, by both faces, scattered or not.
  double leaves(std::size_t j, double depth) const {
    const std::size_t b = first() + j;
    double sum = std::exp(-depth / mu_[b]);
    for (std::size_t k = 0; k < first(); ++k) { // ∫ I 2π μ dμ over π F μ₀, twice
      const double both =
          1.0 / (mu_[k] + mu_[b]) * (X[k] * X[b] - Y[k] * Y[b]) + 1.0 / (mu_[k] - mu_[b]) * (Y[k] * X[b] - X[k] * Y[b]);
      sum += 0.5 * albedo_ * both * mu_[k] * mu_[k] * weight_[k];
    }
    return sum;
  }

private:
  std::size_t first() const { return 96; } // of the asked cosines

  double source(const std::vector<double>& y) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < y.size(); ++k)
      sum += 0.5 * albedo_ * weight_[k] * y[k];
    return sum;
  }

  // Second order: the sources of the middle come from a step with those of the beginning.
  void step(double h) {
    const double k0 = source(Y);
    std::vector<double> middle_x(X), middle_y(Y);
    for (std::size_t i = 0; i < X.size(); ++i) {
      const double decay = std::exp(-0.5 * h / mu_[i]);
      middle_x[i] = X[i] + 0.5 * h * Y[i] * k0;
      middle_y[i] = Y[i] * decay + X[i] * k0 * mu_[i] * (1.0 - decay);
    }
    const double k = source(middle_y);
    for (std::size_t i = 0; i < X.size(); ++i) {
      const double decay = std::exp(-h / mu_[i]);
      X[i] += h * middle_y[i] * k;
      Y[i] = Y[i] * decay + middle_x[i] * k * mu_[i] * (1.0 - decay);
    }
  }

  double albedo_;
  std::vector<double> mu_, weight_, X, Y;
};

} // namespace keeler::test
