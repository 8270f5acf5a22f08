#include "size_classes.hpp"

#include "states.hpp"

#include <keeler/diagnostics/dispersion.hpp>

#include <doctest/doctest.h>

namespace size_classes_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

Patch three_sizes() {
  Patch patch = test::uniform({60.0, 40.0, 1.5, 0.0}, 7.0, 300, 1);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double sizes[] = {0.1, 1.0, 10.0};
    const double r = sizes[k % 3];
    patch.radii[k] = r;
    patch.masses[k] = r * r * r;
    patch.velocities[k] += (k / 3 % 2 == 0 ? 1.0 : -1.0) * Vec3(3.0, 2.0, 1.0) / std::sqrt(r);
    patch.positions[k].z() = (k / 3 % 2 == 0 ? 1.0 : -1.0) / r;
  }
  return patch;
}

} // namespace

TEST_CASE("each class has the motion and the height of its particles") {
  const std::vector<SizeClass> classes = size_classes(three_sizes(), 4);
  REQUIRE(classes.size() == 4);
  CHECK(classes[0].smallest == 0.1);
  CHECK(classes[3].largest == 10.0);
  CHECK(classes[1].smallest == classes[0].largest);
  CHECK(classes[2].smallest == doctest::Approx(1.0));
  std::size_t count = 0;
  double share = 0.0;
  for (const SizeClass& c : classes) {
    count += c.count;
    share += c.mass_fraction;
  }
  CHECK(count == 300);
  CHECK(share == doctest::Approx(1.0).epsilon(1e-12));
  for (const auto& [c, r] : {std::pair(classes[0], 0.1), std::pair(classes[3], 10.0)}) {
    CHECK(c.count == 100);
    CHECK((c.dispersion - Vec3(3.0, 2.0, 1.0) / std::sqrt(r)).norm() < 1e-12);
    CHECK(c.scale_height == doctest::Approx(1.0 / r).epsilon(1e-12));
  }
}

TEST_CASE("one class has the dispersion of the patch, equal spheres have none") {
  const Patch patch = three_sizes();
  const std::vector<SizeClass> all = size_classes(patch, 1);
  REQUIRE(all.size() == 1);
  CHECK((all[0].dispersion - velocity_dispersion(patch)).norm() < 1e-12);
  CHECK(all[0].scale_height == doctest::Approx(scale_height(patch)).epsilon(1e-12));
  CHECK(all[0].mass_fraction == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(size_classes(test::uniform({60.0, 40.0, 1.5, 0.0}, 7.0, 50, 1)).empty());
}

} // namespace size_classes_test
