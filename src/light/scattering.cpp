#include <keeler/light/scattering.hpp>

#include "frame.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::light {
namespace {

const double seeliger_scale = 3.0 / (8.0 * (1.0 - std::log(2.0))); // I/F = ϖ · this · μ0/(μ + μ0)

class Lambert final : public ScatteringLaw {
public:
  explicit Lambert(double albedo) : albedo_(albedo) {}

  double brightness(const Vec3& normal, const Vec3&, const Vec3& from) const override {
    return albedo_ * std::max(0.0, normal.dot(from));
  }

  Scattering scatter(const Vec3& normal, const Vec3&, RandomStream& random) const override {
    return {direction_about(normal, std::sqrt(random.uniform()), random), albedo_};
  }

  bool of_particle() const override { return false; }

private:
  double albedo_;
};

class LommelSeeliger final : public ScatteringLaw {
public:
  explicit LommelSeeliger(double albedo) : scale_(albedo * seeliger_scale) {}

  double brightness(const Vec3& normal, const Vec3& to, const Vec3& from) const override {
    const double in = normal.dot(from);
    return in > 0.0 ? scale_ * in / (in + std::max(0.0, normal.dot(to))) : 0.0;
  }

  // μ₀ has the density μ₀/(μ + μ₀) in [0, 1], up to a factor: a uniform draw is accepted in proportion to it.
  Scattering scatter(const Vec3& normal, const Vec3& to, RandomStream& random) const override {
    const double out = std::max(1e-12, normal.dot(to));
    double in = 0.0;
    do
      in = random.uniform();
    while (random.uniform() * (out + in) > in * (1.0 + out));
    return {direction_about(normal, in, random), 2.0 * scale_ * (1.0 - out * std::log((1.0 + out) / out))};
  }

  bool of_particle() const override { return false; }

private:
  double scale_;
};

// P is linear in α between the nodes; integrals and draws are those of this function.
class Particle final : public ScatteringLaw {
public:
  Particle(const PhaseFunction& phase_function, double albedo) : albedo_(albedo), values_(nodes), sums_(nodes) {
    double largest = 0.0;
    for (std::size_t k = 0; k < nodes; ++k) {
      values_[k] = phase_function(angle(k));
      if (!(values_[k] >= 0.0) || !std::isfinite(values_[k]))
        throw UsageError(fmt::format("the phase function is {:g} at the phase angle {:g} degrees; it must be a number "
                                     "from 0 on, so correct it",
                                     values_[k], angle(k) * 180.0 / pi));
      largest = std::max(largest, values_[k]);
    }
    if (!(largest > 0.0))
      throw UsageError("the phase function is 0 at all phase angles; give one that scatters light");
    for (std::size_t k = 1; k < nodes; ++k)
      sums_[k] = sums_[k - 1] + integral(k - 1);
    const double scale = 2.0 / sums_.back(); // ∫ P sin α dα = 2
    for (std::size_t k = 0; k < nodes; ++k) {
      values_[k] *= scale;
      sums_[k] *= scale;
    }
  }

  double brightness(const Vec3&, const Vec3& to, const Vec3& from) const override {
    const double alpha = std::acos(std::clamp(to.dot(from), -1.0, 1.0)) / width;
    const std::size_t k = std::min(static_cast<std::size_t>(alpha), nodes - 2);
    return 0.25 * albedo_ * std::lerp(values_[k], values_[k + 1], alpha - static_cast<double>(k));
  }

  Scattering scatter(const Vec3&, const Vec3& to, RandomStream& random) const override {
    const auto above = std::upper_bound(sums_.begin(), sums_.end() - 1, random.uniform() * sums_.back());
    const auto k = static_cast<std::size_t>(above - sums_.begin()) - 1;
    const double first = std::cos(angle(k)), last = std::cos(angle(k + 1));
    const double highest = std::max(values_[k], values_[k + 1]);
    double cosine = 0.0, value = 0.0;
    do {
      cosine = std::lerp(first, last, random.uniform());
      const double part =
          std::clamp(std::acos(std::clamp(cosine, -1.0, 1.0)) / width - static_cast<double>(k), 0.0, 1.0);
      value = std::lerp(values_[k], values_[k + 1], part);
    } while (random.uniform() * highest > value);
    return {direction_about(to, cosine, random), albedo_};
  }

  bool of_particle() const override { return true; }

private:
  static constexpr std::size_t nodes = 8193;
  static constexpr double width = pi / (nodes - 1);
  static double angle(std::size_t k) { return width * static_cast<double>(k); }

  // Returns ∫ P sin α dα from node k to the next one.
  double integral(std::size_t k) const {
    const double a = angle(k), b = angle(k + 1), slope = (values_[k + 1] - values_[k]) / width;
    // by parts; the differences of cosines and sines as products keep their digits
    const double cosines = 2.0 * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a)); // cos a − cos b
    const double sines = 2.0 * std::cos(0.5 * (a + b)) * std::sin(0.5 * (b - a));   // sin b − sin a
    return values_[k] * cosines + slope * (sines - width * std::cos(b));
  }

  double albedo_;
  std::vector<double> values_, sums_; // P at the nodes; ∫ P sin α from 0
};

} // namespace

SharedLaw particle_law(const PhaseFunction& phase_function, double albedo) {
  return std::make_shared<Particle>(phase_function, albedo);
}

SharedLaw isotropic_law(double albedo) {
  return particle_law([](double) { return 1.0; }, albedo);
}

SharedLaw power_law(double exponent, double albedo) {
  assert(exponent >= 0.0);
  return particle_law([exponent](double alpha) { return std::pow(std::max(0.0, 1.0 - alpha / pi), exponent); }, albedo);
}

SharedLaw henyey_greenstein_law(double asymmetry, double albedo) {
  assert(std::fabs(asymmetry) < 1.0);
  return particle_law([g = asymmetry](double alpha) { return std::pow(1.0 + g * g + 2.0 * g * std::cos(alpha), -1.5); },
                      albedo);
}

SharedLaw lambert_law(double albedo) {
  return std::make_shared<Lambert>(albedo);
}

SharedLaw lommel_seeliger_law(double albedo) {
  return std::make_shared<LommelSeeliger>(albedo);
}

} // namespace keeler::light
