#include <keeler/cells/grid.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <set>
#include <tuple>

namespace grid_test {

using namespace keeler;
using namespace keeler::cells;

TEST_CASE("a query visits exactly the images inside its window, each once") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    RandomStream random(seed, RandomPurpose::position, 0);
    const ShearingBox box{5.0 + 30.0 * random.uniform(), 5.0 + 30.0 * random.uniform(), 1.5, 0.0};
    const double offset = random.uniform() * box.size_y;
    std::vector<Vec3> points;
    for (int k = 0; k < 60; ++k) // some outside the cell
      points.emplace_back((random.uniform() - 0.5) * 1.4 * box.size_x, (random.uniform() - 0.5) * 1.4 * box.size_y,
                          0.0);
    PeriodicGrid grid;
    grid.build(points, box, offset, 0.5 + 4.0 * random.uniform());

    const double reach_x = 8.0 * random.uniform(), reach_y = 25.0 * random.uniform();
    for (int k = 0; k < 10; ++k) {
      const Vec3& centre = points[k];
      std::multiset<std::tuple<std::size_t, int, int>> seen, expected;
      grid.visit_near(centre, reach_x, reach_y,
                      [&](std::size_t j, const Image& image) { seen.emplace(j, image.nx, image.ny); });
      for (std::size_t j = 0; j < points.size(); ++j)
        for (int nx = -6; nx <= 6; ++nx)
          for (int ny = -15; ny <= 15; ++ny) {
            const Vec3 d = points[j] + box.displacement({nx, ny}, offset) - centre;
            if (std::fabs(d.x()) <= reach_x && std::fabs(d.y()) <= reach_y)
              expected.emplace(j, nx, ny);
          }
      CHECK(seen == expected);
    }
  }
}

} // namespace grid_test
