#include <keeler/states/uniform.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/particles/sizes.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

// A layer of equal spheres with a Gaussian mid-plane filling factor: (4/3) τ r / (√(2π) H).
UniformRequest layer(double optical_depth, double filling, std::size_t count, std::uint64_t seed) {
  UniformRequest request;
  const double side = std::sqrt(static_cast<double>(count) * pi / optical_depth);
  request.box = {side, side, request.frequencies.shear(), 0.37 * side};
  request.radii.assign(count, 1.0);
  request.dispersion_z = 4.0 / 3.0 * optical_depth / (std::sqrt(two_pi) * filling);
  request.dispersion_x = request.dispersion_z / 0.65;
  request.seed = seed;
  return request;
}

} // namespace

TEST_CASE("no overlaps, up to a mid-plane filling of 0.4, and the dispersion asked for") {
  for (const double filling : {0.05, 0.2, 0.4})
    for (const double optical_depth : {0.1, 0.5, 1.5}) {
      const UniformRequest request = layer(optical_depth, filling, 2000, 3);
      const Patch patch = uniform_patch(request);
      CHECK(largest_overlap(patch).depth == 0.0);
      double x2 = 0.0, y2 = 0.0, z2 = 0.0;
      for (std::size_t k = 0; k < patch.size(); ++k) {
        const Vec3& v = patch.velocities[k];
        x2 += v.x() * v.x();
        y2 += std::pow(v.y() + 1.5 * patch.positions[k].x(), 2);
        z2 += v.z() * v.z();
      }
      // five standard errors of a standard deviation from 2000 draws: 5/sqrt(4000) = 8 %
      CHECK(std::sqrt(x2 / 2000) == doctest::Approx(request.dispersion_x).epsilon(0.08));
      CHECK(std::sqrt(y2 / 2000) == doctest::Approx(0.5 * request.dispersion_x).epsilon(0.08));
      CHECK(std::sqrt(z2 / 2000) == doctest::Approx(request.dispersion_z).epsilon(0.08));
    }
}

TEST_CASE("dense layers whose particles take more room than their motion are placed too") {
  // c_z below what the filling of 0.4 asks of a Gaussian layer: the particles themselves hold the layer up
  struct Case {
    double optical_depth, dispersion_z;
  };
  for (const Case& c : {Case{1.5, 1.21}, Case{1.0, 0.78}, Case{0.5, 0.03}}) {
    UniformRequest request = layer(c.optical_depth, 0.4, 1500, 5);
    request.dispersion_z = c.dispersion_z;
    CHECK(largest_overlap(uniform_patch(request)).depth == 0.0);
  }
}

TEST_CASE("the same state for the same seed, whatever the threads") {
  const UniformRequest request = layer(0.8, 0.3, 1500, 9);
  set_threads(1);
  const Patch one = uniform_patch(request);
  set_threads(3);
  const Patch three = uniform_patch(request);
  CHECK(one.positions == three.positions);
  CHECK(one.velocities == three.velocities);
  CHECK(uniform_patch(layer(0.8, 0.3, 1500, 10)).positions != one.positions);
}

TEST_CASE("sizes over a decade are placed without overlap") {
  UniformRequest request = layer(0.5, 0.1, 3000, 4);
  request.radii = draw_radii(power_sizes(3.0, 0.3, 3.0), 3000, 4);
  request.dispersion_z = 3.0;
  CHECK(largest_overlap(uniform_patch(request)).depth == 0.0);
}

TEST_CASE("a request that no packing can meet is refused in words") {
  UniformRequest request = layer(1.2, 0.4, 300, 1);
  request.dispersion_z = 0.0; // a monolayer cannot hold τ = 1.2
  for (double& radius : request.radii)
    radius = 1.0;
  CHECK_THROWS_AS(uniform_patch(request), UsageError);
}
