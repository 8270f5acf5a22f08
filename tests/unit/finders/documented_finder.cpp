// The example finder of docs/dev/finders.md, built as that page says, agrees with the certified finder.
#include <keeler/finders/finders.hpp>

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

namespace documented_finder_test {

using namespace keeler;
using namespace keeler::finders;

TEST_CASE("the finder that the documentation adds is in the table and finds contacts") {
  const Frequencies f;
  const double h = two_pi * 1e-2;
  const auto certified = make_finder("certified"), added = make_finder("secant-full");
  REQUIRE(added);
  RandomStream random(9, RandomPurpose::position, 0);
  int hits = 0, misses = 0;
  for (int k = 0; k < 2000; ++k) {
    // both spheres of radius 1; inside contact at the end of the step, outside at its start, or far off
    const Vec3 place(random.normal(), random.normal(), random.normal());
    const Vec3 velocity(-20.0 * random.uniform(), random.normal(), random.normal());
    std::vector<Body> bodies(2, Body{{}, 1.0, 1.0});
    bodies[1].elements = elements_from({place, velocity}, f, Rotation(f, 0.5 * h));
    DriftStep step(f, -0.5 * h, 0.5 * h, 100.0);
    step.bodies = bodies;
    certified->begin(step);
    added->begin(step);
    const Query query{0, 1, 0.0, 0.0, step.begin};
    const FinderResult truth = certified->find(query), found = added->find(query);
    if (found.exit == FinderExit::hit) {
      REQUIRE(truth.exit == FinderExit::hit);
      CHECK(std::fabs(found.time - truth.time) < 1e-8); // |f| < 4e-10 over a slope above 0.1
      ++hits;
    } else if (!truth.contact()) {
      CHECK_FALSE(found.contact());
      ++misses;
    }
  }
  CHECK(hits > 100);
  CHECK(misses > 100);
}

} // namespace documented_finder_test
