#include <keeler/particles/sizes.hpp>

#include <keeler/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keeler {
namespace {

// ∫ r^p dr between a and b.
double power_integral(double p, double a, double b) {
  return std::fabs(p + 1.0) < 1e-12 ? std::log(b / a) : (std::pow(b, p + 1.0) - std::pow(a, p + 1.0)) / (p + 1.0);
}

// The radius below which a fraction u of a power law lies.
double power_quantile(const SizeLaw& law, double u) {
  const double p = 1.0 - law.exponent;
  if (std::fabs(p) < 1e-12)
    return law.min * std::pow(law.max / law.min, u);
  const double low = std::pow(law.min, p), high = std::pow(law.max, p);
  return std::clamp(std::pow(low + u * (high - low), 1.0 / p), law.min, law.max);
}

} // namespace

double SizeLaw::mean_power(int k) const {
  switch (kind) {
  case Kind::equal:
    return std::pow(min, k);
  case Kind::power:
    return power_integral(k - exponent, min, max) / power_integral(-exponent, min, max);
  case Kind::file:
    break;
  }
  double sum = 0.0;
  for (const double radius : listed)
    sum += std::pow(radius, k);
  return sum / static_cast<double>(listed.size());
}

double SizeLaw::largest() const {
  return kind == Kind::file ? *std::max_element(listed.begin(), listed.end()) : max;
}

std::vector<double> draw_radii(const SizeLaw& law, std::size_t count, std::uint64_t seed) {
  std::vector<double> radii(count, law.min);
  if (law.kind == SizeLaw::Kind::equal)
    return radii;
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(seed, RandomPurpose::size, k);
    const double u = (static_cast<double>(k) + random.uniform()) / static_cast<double>(count);
    radii[k] = law.kind == SizeLaw::Kind::power ? power_quantile(law, u) : law.listed[k % law.listed.size()];
  }
  for (std::size_t k = count; k > 1; --k) { // Fisher–Yates
    RandomStream random(seed, RandomPurpose::size, count + k);
    std::swap(radii[k - 1], radii[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
  }
  return radii;
}

} // namespace keeler
