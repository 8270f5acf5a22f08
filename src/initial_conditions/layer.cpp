#include "layer.hpp"

#include <keeler/core/units.hpp>

#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {

double LayerProfile::midplane_density() const {
  if (slab == 0.0)
    return 1.0 / (std::sqrt(two_pi) * sigma);
  return sigma > 0.0 ? std::erf(slab / (std::sqrt(2.0) * sigma)) / (2.0 * slab) : 1.0 / (2.0 * slab);
}

LayerProfile LayerProfile::of_height(double height, double filling, double largest) {
  assert(height >= 0.0 && largest > 0.0);
  if (!(filling > largest))
    return {0.0, height};
  const double target = largest / filling / (std::sqrt(two_pi) * height);
  const auto with_slab = [&](double fraction) { // of ⟨z²⟩, due to the slab
    return LayerProfile{height * std::sqrt(3.0 * fraction), height * std::sqrt(1.0 - fraction)};
  };
  double low = 0.0, high = 1.0; // the density falls with the fraction
  for (int halving = 0; halving < 16; ++halving) {
    const double fraction = 0.5 * (low + high);
    (with_slab(fraction).midplane_density() > target ? low : high) = fraction;
  }
  return with_slab(high);
}

} // namespace keeler::initial_conditions
