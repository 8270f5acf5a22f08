// Height and mid-plane filling of a layer.
#include <keeler/core/units.hpp>
#include <keeler/scene/layer.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace layer_test {

using namespace keeler;
using namespace keeler::scene;

TEST_CASE("the mid-plane filling agrees with sampled particles") {
  // brute force: particles of a power law in a Gaussian layer, the volume of the slices of each at z = 0
  const particles::SizeLaw sizes = particles::power_sizes(3.0, 0.5, 3.0);
  const LayerSizes layer = layer_sizes(sizes, 20000);
  const double depth = 0.4, dispersion = 20.0, nu = 1.3; // thick compared with a particle, as the formula has it
  const std::vector<double> radii = draw_radii(sizes, 20000, 3);
  const double height = layer_height(depth, layer, dispersion, nu);
  double area_sum = 0.0, sliced = 0.0;
  for (const double r : radii) {
    area_sum += pi * r * r;
    constexpr int slices = 200; // centres at z within r of the mid-plane, each cutting a disc π (r² − z²) out of it
    for (int k = 0; k < slices; ++k) {
      const double z = r * (2.0 * (k + 0.5) / slices - 1.0);
      const double density = std::exp(-0.5 * z * z / (height * height)) / (std::sqrt(two_pi) * height);
      sliced += density * pi * (r * r - z * z) * 2.0 * r / slices;
    }
  }
  // 1 %: the particles' own size, (r/H)²/10 with H = 9.6 m, and the sampling of the moments
  CHECK(midplane_filling(depth, layer, dispersion, nu) == doctest::Approx(depth * sliced / area_sum).epsilon(0.01));
}

TEST_CASE("a single body is weighted with the mass of the others, for any number of repetitions of a list") {
  // brute force: R = Σ m (1 − m/M) / Σ area, over the particles themselves
  const auto drawn = [](const particles::SizeLaw& sizes, std::size_t count) {
    double cubes = 0.0, sixths = 0.0, squares = 0.0;
    for (const double r : draw_radii(sizes, count, 1)) {
      squares += r * r;
      cubes += r * r * r;
      sixths += std::pow(r, 6);
    }
    return (cubes - sixths / cubes) / squares;
  };
  std::vector<double> radii(500, 1.0);
  radii.front() = 20.0;
  const particles::SizeLaw moonlet = particles::listed_sizes(radii);
  CHECK(layer_sizes(moonlet, 500).effective_radius == doctest::Approx(drawn(moonlet, 500)).epsilon(1e-9));
  CHECK(layer_sizes(moonlet, 500).effective_radius <
        1.1); // ⟨r³⟩/⟨r²⟩ is 9.4: the grains share the area with the moonlet
  CHECK(layer_sizes(moonlet, 50000).effective_radius == doctest::Approx(drawn(moonlet, 50000)).epsilon(1e-9));
  CHECK(layer_sizes(moonlet, 50000).effective_radius > 9.0); // a hundred moonlets are a crowd
}

TEST_CASE("the layer's height agrees with reference equilibria, and the filling can be inverted") {
  // REBOUND 6c44115f, equal spheres of 1 m without self-gravity: c_z and H; 5 %
  const LayerSizes equal{1.0, 1.0};
  const double reference[][3] = {{0.1, 1.80, 1.86}, {0.5, 1.45, 1.73}, {1.0, 1.17, 1.74}};
  for (const auto& [depth, c_z, height] : reference)
    CHECK(layer_height(depth, equal, c_z / vertical_fraction, 1.0) == doctest::Approx(height).epsilon(0.05));
  for (const double dispersion : {1.0, 2.0, 7.0}) {
    const double filling = midplane_filling(0.8, equal, dispersion, 1.1);
    CHECK(dispersion_for_filling(0.8, equal, 1.1, filling) == doctest::Approx(dispersion).epsilon(1e-12));
    CHECK(optical_depth_for_filling(equal, dispersion, 1.1, filling) == doctest::Approx(0.8).epsilon(1e-12));
  }
  CHECK(dispersion_for_filling(0.1, equal, 1.0, 0.4) == 0.0);
}

} // namespace layer_test
