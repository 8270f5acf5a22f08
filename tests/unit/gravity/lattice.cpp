#include "lattice.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace lattice_test {

using namespace keeler;
using namespace keeler::gravity;

namespace {

// The lattice's field by another sum (Lekner 1991, Physica A 176, 485): row by row along y, each row by its waves,
// whose profiles across are Bessel functions; the rows' means, line masses, have a closed sum. No split, no erfc.
Vec3 by_rows(const ShearingBox& box, double offset, const Vec3& at) {
  const double per_y = 2.0 * pi / box.size_y, per_x = 2.0 * pi / box.size_x;
  const double beat = std::cosh(per_x * at.z()) - std::cos(per_x * at.x());
  const double lines = -per_x / box.size_y / beat;
  Vec3 sum(lines * std::sin(per_x * at.x()), 0.0, lines * std::sinh(per_x * at.z()));
  for (int n = -60; n <= 60; ++n) {
    const double x = at.x() - n * box.size_x, y = at.y() + n * offset, rho = std::hypot(x, at.z());
    for (int p = 1; per_y * p * rho < 40.0; ++p) {
      const double k = per_y * p;
      const double out = -4.0 * k / box.size_y * std::cyl_bessel_k(1.0, k * rho) * std::cos(k * y) / rho;
      sum += Vec3(out * x, -4.0 * k / box.size_y * std::cyl_bessel_k(0.0, k * rho) * std::sin(k * y), out * at.z());
    }
  }
  return sum;
}

} // namespace

TEST_CASE("Ewald's sum of the lattice's field equals the sum row by row") {
  for (const ShearingBox& box :
       {ShearingBox{50.0, 50.0, 1.5, 0.0}, ShearingBox{40.0, 100.0, 1.5, 0.0}, ShearingBox{300.0, 60.0, 1.5, 0.0}}) {
    for (const double part : {0.0, 0.3, 0.5, 0.99}) {
      const Lattice lattice(box, part * box.size_y);
      RandomStream random(1, RandomPurpose::position, 7);
      for (int k = 0; k < 60; ++k) {
        Vec3 at;
        at.x() = (0.02 + 0.96 * random.uniform()) * box.size_x; // rows converge slowly near their own line
        at.y() = (random.uniform() - 0.5) * 2.0 * box.size_y;
        at.z() = std::pow(10.0, 4.0 * random.uniform() - 2.0);
        const Vec3 a = lattice.acceleration(at), b = by_rows(box, part * box.size_y, at);
        CHECK((a - b).norm() < 1e-11 * b.norm() + 1e-12 / box.area());
      }
    }
  }
}

TEST_CASE("the gradient of the lattice's potential is minus the acceleration") {
  const ShearingBox box{50.0, 70.0, 1.5, 0.0};
  const Lattice lattice(box, 20.0);
  const double h = 1e-3;
  for (const Vec3& at : {Vec3(3.0, 4.0, 0.5), Vec3(25.0, 35.0, 0.0), Vec3(-20.0, 60.0, 30.0)}) {
    const Vec3 a = lattice.acceleration(at);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = h * Vec3::Unit(axis);
      const double slope = (lattice.potential(at + step) - lattice.potential(at - step)) / (2.0 * h);
      CHECK(a[axis] == doctest::Approx(-slope).epsilon(1e-6).scale(1.0 / box.area()));
    }
  }
}

TEST_CASE("a lattice attracts as a point mass nearby, as a sheet far above, and equally at every image") {
  const ShearingBox box{50.0, 70.0, 1.5, 0.0};
  const Lattice lattice(box, 33.0);
  const Vec3 near(1e-3, 2e-3, -2e-3);
  CHECK((lattice.acceleration(near) + near / std::pow(near.norm(), 3)).norm() < 1e-9 / near.squaredNorm());
  const Vec3 above = lattice.acceleration({7.0, 9.0, 500.0});
  CHECK(above.z() == doctest::Approx(-2.0 * pi / box.area()).epsilon(1e-13));
  CHECK(above.head<2>().norm() < 1e-13 / box.area());
  const Vec3 at(11.0, -8.0, 3.0);
  for (const Image image : {Image{1, 0}, Image{0, 1}, Image{-3, 2}})
    CHECK((lattice.acceleration(at + box.displacement(image, 33.0)) - lattice.acceleration(at)).norm() <
          1e-12 / box.area());
  CHECK(lattice.acceleration(Vec3::Zero()).norm() < 1e-15 / box.area());
}

} // namespace lattice_test
