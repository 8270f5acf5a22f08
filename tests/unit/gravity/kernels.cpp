#include <keeler/gravity/kernels.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

using namespace keeler;

namespace {

TargetBlock random_targets() {
  TargetBlock targets{};
  RandomStream random(11, RandomPurpose::position, 0);
  for (std::size_t k = 0; k < TargetBlock::capacity; ++k) {
    targets.x[k] = random.normal();
    targets.y[k] = random.normal();
    targets.z[k] = random.normal();
  }
  return targets;
}

std::vector<CellSource> random_cells(std::size_t count) {
  std::vector<CellSource> cells;
  RandomStream random(12, RandomPurpose::position, 0);
  for (std::size_t k = 0; k < count; ++k) {
    CellSource c{10.0 + random.normal(),
                 random.normal(),
                 random.normal(),
                 random.uniform(),
                 random.normal(),
                 random.normal(),
                 0.0,
                 random.normal(),
                 random.normal(),
                 random.normal()};
    c.zz = -c.xx - c.yy;
    cells.push_back(c);
  }
  return cells;
}

// −φ at a place: m/d + (d·Q d) / (2 d⁵).
long double potential(const CellSource& c, long double x, long double y, long double z) {
  const long double dx = c.x - x, dy = c.y - y, dz = c.z - z;
  const long double d2 = dx * dx + dy * dy + dz * dz, d = std::sqrt(d2);
  const long double dqd =
      c.xx * dx * dx + c.yy * dy * dy + c.zz * dz * dz + 2 * (c.xy * dx * dy + c.xz * dx * dz + c.yz * dy * dz);
  return c.mass / d + dqd / (2 * d2 * d2 * d);
}

} // namespace

TEST_CASE("a cell's attraction is the gradient of its quadrupole potential") {
  const std::vector<CellSource> cells = random_cells(1);
  TargetBlock targets = random_targets();
  attraction_kernels(InstructionSet::portable).cells(targets, 4, cells.data(), 1);
  const long double h = 1e-4L; // truncation h² and rounding 1e-19 / h both stay below 1e-9
  for (std::size_t k = 0; k < 4; ++k) {
    const long double x = targets.x[k], y = targets.y[k], z = targets.z[k];
    const auto slope = [&](long double ex, long double ey, long double ez) {
      return static_cast<double>(
          (potential(cells[0], x + ex, y + ey, z + ez) - potential(cells[0], x - ex, y - ey, z - ez)) / (2 * h));
    };
    CHECK(targets.ax[k] == doctest::Approx(slope(h, 0, 0)).epsilon(1e-7));
    CHECK(targets.ay[k] == doctest::Approx(slope(0, h, 0)).epsilon(1e-7));
    CHECK(targets.az[k] == doctest::Approx(slope(0, 0, h)).epsilon(1e-7));
  }
}

TEST_CASE("kernels of all instruction sets give the same bits, for every number of targets") {
  const std::vector<CellSource> cells = random_cells(37);
  std::vector<PointSource> points;
  for (const CellSource& c : cells)
    points.push_back({c.x, c.y, c.z, c.mass});
  const TargetBlock start = random_targets();
  points.push_back({start.x[5], start.y[5], start.z[5], 1.0}); // a target among its own sources
  for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 63u, 64u}) {
    TargetBlock expected = start;
    attraction_kernels(InstructionSet::portable).points(expected, count, points.data(), points.size());
    attraction_kernels(InstructionSet::portable).cells(expected, count, cells.data(), cells.size());
    for (std::size_t k = 0; k < count; ++k)
      CHECK(std::isfinite(expected.ax[k] + expected.ay[k] + expected.az[k]));
    for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
      if (!supports(set))
        continue;
      TargetBlock targets = start;
      attraction_kernels(set).points(targets, count, points.data(), points.size());
      attraction_kernels(set).cells(targets, count, cells.data(), cells.size());
      CHECK(std::memcmp(targets.ax, expected.ax, count * sizeof(double)) == 0);
      CHECK(std::memcmp(targets.ay, expected.ay, count * sizeof(double)) == 0);
      CHECK(std::memcmp(targets.az, expected.az, count * sizeof(double)) == 0);
    }
  }
}
