#include <keeler/gravity/images.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace images_test {

using namespace keeler;
using namespace keeler::gravity;

namespace {
const ShearingBox box{96.0, 64.0, 1.5, 0.0};
}

TEST_CASE("an offset folds into half a box on either side, exactly") {
  CHECK(folded_offset(box, 10.0) == 10.0);
  CHECK(folded_offset(box, 74.0) == 10.0);
  CHECK(folded_offset(box, 63.0) == -1.0);
  CHECK(folded_offset(box, -138.0) == -10.0);
}

TEST_CASE("the boxes around the cell lie evenly on both sides of it at any offset") {
  for (const double raw : {0.0, 5.0, 31.0, 32.0, 33.0, 50.0, 63.9})
    for (const int rings : {0, 1, 3}) {
      const std::vector<Vec3> shifts = image_shifts(box, folded_offset(box, raw), rings, rings);
      REQUIRE(shifts.size() == static_cast<std::size_t>((2 * rings + 1) * (2 * rings + 1)));
      CHECK(std::count(shifts.begin(), shifts.end(), Vec3(0.0, 0.0, 0.0)) == 1);
      for (const Vec3& shift : shifts) {
        CHECK(std::count(shifts.begin(), shifts.end(), shift) == 1);
        CHECK(std::count(shifts.begin(), shifts.end(), Vec3(-shift)) == 1);
        CHECK(std::fabs(shift.x()) <= rings * box.size_x);
        CHECK(std::fabs(shift.y()) <= (rings + 0.5) * box.size_y);
      }
    }
}

TEST_CASE("any image of a position is folded back to that position") {
  const double offset = folded_offset(box, 41.5);
  const Vec3 position(40.25, -30.5, 2.0);
  for (const int nx : {-2, 0, 1})
    for (const int ny : {-3, 0, 2}) { // all numbers have few bits: exact
      const Vec3 image = position + box.displacement({nx, ny}, 41.5);
      CHECK(into_cell(box, offset, image) == position);
    }
}

} // namespace images_test
