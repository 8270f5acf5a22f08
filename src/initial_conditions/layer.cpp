#include <keeler/initial_conditions/layer.hpp>

#include <keeler/core/units.hpp>

#include <cmath>

namespace keeler {

double LayerProfile::midplane_density() const {
  if (slab == 0.0)
    return 1.0 / (std::sqrt(two_pi) * sigma);
  return sigma > 0.0 ? std::erf(slab / (std::sqrt(2.0) * sigma)) / (2.0 * slab) : 1.0 / (2.0 * slab);
}

LayerProfile LayerProfile::of_height(double height, double filling, double largest) {
  if (!(filling > largest))
    return {0.0, height};
  const double wanted = largest / filling / (std::sqrt(two_pi) * height);
  const auto with_share = [&](double share) { // of ⟨z²⟩, that is the slab's
    return LayerProfile{height * std::sqrt(3.0 * share), height * std::sqrt(1.0 - share)};
  };
  double low = 0.0, high = 1.0; // the density falls as the share rises
  for (int halving = 0; halving < 16; ++halving) {
    const double share = 0.5 * (low + high);
    (with_share(share).midplane_density() > wanted ? low : high) = share;
  }
  return with_share(high);
}

} // namespace keeler
