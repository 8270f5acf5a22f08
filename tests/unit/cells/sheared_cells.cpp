#include <keeler/cells/sheared_cells.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <tuple>

namespace sheared_cells_test {

using namespace keeler;
using namespace keeler::cells;

TEST_CASE("a traversal visits every point of a window of varying height, and no cell twice") {
  RandomStream random(1, RandomPurpose::position, 0);
  for (int round = 0; round < 60; ++round) {
    const ShearingBox box{5.0 + 30.0 * random.uniform(), 5.0 + 30.0 * random.uniform(), 1.5, 0.0};
    const auto axis = [&](double length) { // the last cell is cut off
      const double width = 0.5 + 4.0 * random.uniform();
      return CellAxis(length, width, static_cast<std::size_t>(std::ceil(length / width)));
    };
    const CellAxis x = axis(box.size_x), y = axis(box.size_y);
    const ShearedCells cells{box, random.uniform() * box.size_y, x, y};
    const double radius = 15.0 * random.uniform(), centre_x = 100.0 * (random.uniform() - 0.5), centre_y = 7.0;
    const auto circle = [&](double from) {
      const double gap = std::max({0.0, from - centre_x, centre_x - from - x.width});
      const double reach = std::sqrt(std::max(0.0, radius * radius - gap * gap));
      return std::pair(centre_y - reach, centre_y + reach);
    };
    std::set<std::tuple<std::size_t, int, int>> seen;
    cells.visit_window(centre_x - radius, centre_x + radius, circle,
                       [&](std::size_t first, std::size_t last, const Image& image) {
                         CHECK(first <= last);
                         CHECK(last < cells.count());
                         for (std::size_t cell = first; cell <= last; ++cell)
                           CHECK(seen.emplace(cell, image.nx, image.ny).second);
                       });
    for (int k = 0; k < 200; ++k) {
      const double angle = 6.28 * random.uniform(), distance = 0.999999 * radius * std::sqrt(random.uniform());
      const double at_x = centre_x + distance * std::cos(angle), at_y = centre_y + distance * std::sin(angle);
      const Image home = box.image_into_cell(at_x, at_y, cells.offset);
      const Vec3 inside = Vec3(at_x, at_y, 0.0) + box.displacement(home, cells.offset);
      CHECK(seen.count({cells.cell(inside.x(), inside.y()), -home.nx, -home.ny}) == 1);
    }
  }
}

} // namespace sheared_cells_test
