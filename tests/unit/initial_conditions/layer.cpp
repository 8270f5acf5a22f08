#include "layer.hpp"

#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

namespace layer_test {

using namespace keeler;
using namespace keeler::initial_conditions;

TEST_CASE("a layer that is sparse enough is Gaussian, a denser one has the same height and the filling allowed") {
  const double height = 2.3;
  for (const double filling : {0.1, 0.55, 0.56, 0.62, 0.7}) {
    const LayerProfile profile = LayerProfile::of_height(height, filling, 0.55);
    CHECK(std::sqrt(profile.slab * profile.slab / 3.0 + profile.sigma * profile.sigma) == doctest::Approx(height));
    const double gaussian = 1.0 / (std::sqrt(two_pi) * height);
    CHECK(profile.midplane_density() == doctest::Approx(gaussian * std::fmin(1.0, 0.55 / filling)).epsilon(1e-4));
    CHECK((profile.slab == 0.0) == (filling <= 0.55));
  }
  // no profile of this family is flatter than a slab of ± √3 H
  const LayerProfile flattest = LayerProfile::of_height(height, 5.0, 0.55);
  CHECK(flattest.midplane_density() == doctest::Approx(0.5 / (std::sqrt(3.0) * height)).epsilon(1e-3));
}

TEST_CASE("the density in the mid-plane is that of the two parts folded together") {
  // brute force: ∫ of the slab's density times the Gaussian's at −z
  const LayerProfile profile{1.7, 0.6};
  double sum = 0.0;
  constexpr int slices = 20000;
  for (int k = 0; k < slices; ++k) {
    const double z = profile.slab * (2.0 * (k + 0.5) / slices - 1.0);
    sum += std::exp(-0.5 * z * z / (profile.sigma * profile.sigma)) / (std::sqrt(two_pi) * profile.sigma) / slices;
  }
  CHECK(profile.midplane_density() == doctest::Approx(sum).epsilon(1e-6));
}

} // namespace layer_test
