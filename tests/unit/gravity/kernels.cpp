#include "kernels.hpp"

#include "blocks.hpp"

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace kernels_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

// Returns −φ at a position: m/d + (d·Q d) / (2 d⁵).
long double potential(const CellSource& c, long double x, long double y, long double z) {
  const long double dx = c.x - x, dy = c.y - y, dz = c.z - z;
  const long double d2 = dx * dx + dy * dy + dz * dz, d = std::sqrt(d2);
  const long double dqd =
      c.xx * dx * dx + c.yy * dy * dy + c.zz * dz * dz + 2 * (c.xy * dx * dy + c.xz * dx * dz + c.yz * dy * dz);
  return c.mass / d + dqd / (2 * d2 * d2 * d);
}

// Returns the largest |a − b| over the targets, relative to the larger of b's own length and `floor`.
template<class A, class B> double worst(const A& a, const B& b, std::size_t count) {
  double error = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double d = std::hypot(a.ax[k] - b.ax[k], a.ay[k] - b.ay[k], a.az[k] - b.az[k]);
    error = std::max(error, d / std::hypot(b.ax[k], b.ay[k], b.az[k]));
  }
  return error;
}

template<class Block> void check_same_sums(const Block& a, const Block& b, std::size_t count) {
  const auto same_bits = [&](const auto& one, const auto& other) {
    return std::memcmp(one, other, count * sizeof(double)) == 0;
  };
  CHECK(same_bits(a.ax, b.ax));
  CHECK(same_bits(a.ay, b.ay));
  CHECK(same_bits(a.az, b.az));
}

} // namespace

TEST_CASE("a pair attracts by Newton's law, at any distance and anywhere, in both precisions") {
  const AttractionKernels kernels = attraction_kernels(InstructionSet::portable);
  RandomStream random(13, RandomPurpose::position, 0);
  double worst_double = 0.0, worst_single = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const Point target = {1e3 * random.normal(), 1e4 * random.normal(), 10.0 * random.normal()};
    const double distance = std::pow(10.0, 8.0 * random.uniform() - 3.0); // 1 mm to 100 km
    const Point source = {target.x + distance * random.normal(), target.y + distance * random.normal(),
                          target.z + distance * random.normal()};
    const std::vector<PointSource> sources = {{source.x, source.y, source.z, 0.3}};
    const std::vector<SinglePoint> singles = in_single(sources);
    const PointRange all{0, 1};
    const TargetBlock exact = plain_sum(targets_at({target}), 1, sources);
    TargetBlock in_double = targets_at({target});
    SingleTargetBlock in_float = single_targets_at({target});
    kernels.points(in_double, 1, sources.data(), 1);
    kernels.points_single(in_float, 1, singles.data(), &all, 1);
    worst_double = std::max(worst_double, worst(in_double, exact, 1));
    worst_single = std::max(worst_single, worst(in_float, exact, 1));
  }
  MESSAGE("worst pair, double and single precision: " << worst_double << " " << worst_single);
  CHECK(worst_double < 2e-15); // some ten roundings
  CHECK(worst_single < 1e-6);
}

TEST_CASE("single precision loses nothing over many sources") {
  const AttractionKernels kernels = attraction_kernels(InstructionSet::portable);
  const std::vector<PointSource> sources = random_points(3000);
  const std::vector<SinglePoint> singles = in_single(sources);
  const PointRange ranges[] = {{0, 1000}, {1000, 3}, {1003, 1997}};
  const TargetBlock exact = plain_sum(random_targets(), 64, sources);
  TargetBlock in_double = random_targets();
  SingleTargetBlock in_float = in_single(random_targets());
  kernels.points(in_double, 64, sources.data(), sources.size());
  kernels.points_single(in_float, 64, singles.data(), ranges, 3);
  CHECK(worst(in_double, exact, 64) < 1e-13); // sums that cancel to a hundredth, of terms good to 1e-15
  CHECK(worst(in_float, exact, 64) < 1e-5);
}

TEST_CASE("a target among the sources does not attract itself, but its neighbours do at any distance") {
  const AttractionKernels kernels = attraction_kernels(InstructionSet::portable);
  const Point at = {8123.456789, -377.7654321, 3.1415926535};
  const double gap = 1e-5; // m, and thousands away from the origin
  const std::vector<PointSource> sources = {{at.x, at.y, at.z, 1.0}, {at.x + gap, at.y, at.z, 1e-6}};
  const std::vector<SinglePoint> singles = in_single(sources);
  const PointRange all{0, 2};
  TargetBlock in_double = targets_at({at});
  SingleTargetBlock in_float = single_targets_at({at});
  kernels.points(in_double, 1, sources.data(), 2);
  kernels.points_single(in_float, 1, singles.data(), &all, 1);
  const double distance = sources[1].x - at.x, newton = 1e-6 / (distance * distance);
  CHECK(in_double.ax[0] == doctest::Approx(newton).epsilon(1e-14));
  CHECK(in_float.ax[0] == doctest::Approx(newton).epsilon(1e-5)); // positions are stored to 2^-48 of 8 km, 3e-11 m
  CHECK(in_double.ay[0] == 0.0);
  CHECK(in_float.ay[0] == 0.0);
}

TEST_CASE("a cell's attraction is the gradient of its quadrupole potential") {
  const std::vector<CellSource> cells = random_cells(1);
  SingleTargetBlock targets = in_single(random_targets());
  attraction_kernels(InstructionSet::portable).cells(targets, 4, cells.data(), 1);
  const long double h = 1e-4L; // truncation h² and rounding 1e-19 / h both stay below 1e-9
  for (std::size_t k = 0; k < 4; ++k) {
    const long double x = targets.from_x[k], y = targets.from_y[k], z = targets.from_z[k];
    const auto slope = [&](long double ex, long double ey, long double ez) {
      return static_cast<double>(
          (potential(cells[0], x + ex, y + ey, z + ez) - potential(cells[0], x - ex, y - ey, z - ez)) / (2 * h));
    };
    const double exact[3] = {slope(h, 0, 0), slope(0, h, 0), slope(0, 0, h)};
    const double tolerance = 1e-6 * std::hypot(exact[0], exact[1], exact[2]); // ten roundings of floats
    CHECK(std::fabs(targets.ax[k] - exact[0]) < tolerance);
    CHECK(std::fabs(targets.ay[k] - exact[1]) < tolerance);
    CHECK(std::fabs(targets.az[k] - exact[2]) < tolerance);
  }
}

TEST_CASE("kernels of all instruction sets give equal bits, for every number of targets") {
  const TargetBlock start = random_targets();
  std::vector<PointSource> points = random_points(170);
  points.push_back({start.x[5], start.y[5], start.z[5], 1.0}); // a target among its own sources
  const std::vector<SinglePoint> singles = in_single(points);
  const PointRange ranges[] = {{3, 150}, {160, 1}, {161, 10}};
  const std::vector<CellSource> cells = random_cells(37);
  const FarCells far = far_cells(random_cells(45));
  const auto run = [&](InstructionSet set, std::size_t count, TargetBlock& in_double, SingleTargetBlock& in_float) {
    const AttractionKernels kernels = attraction_kernels(set);
    kernels.points(in_double, count, points.data(), points.size());
    kernels.points_single(in_float, count, singles.data(), ranges, 3);
    kernels.cells(in_float, count, cells.data(), cells.size());
    LocalTerms terms{};
    kernels.far_cells(terms, far, 45);
    kernels.local(in_float, count, terms);
  };
  for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 17u, 64u, 127u, 128u}) {
    TargetBlock expected = start;
    SingleTargetBlock expected_single = in_single(start);
    run(InstructionSet::portable, count, expected, expected_single);
    for (std::size_t k = 0; k < count; ++k) {
      CHECK(std::isfinite(expected.ax[k] + expected.ay[k] + expected.az[k]));
      CHECK(std::isfinite(expected_single.ax[k] + expected_single.ay[k] + expected_single.az[k]));
    }
    for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
      if (!supports(set))
        continue;
      TargetBlock targets = start;
      SingleTargetBlock single_targets = in_single(start);
      run(set, count, targets, single_targets);
      check_same_sums(targets, expected, count);
      check_same_sums(single_targets, expected_single, count);
    }
  }
}

} // namespace kernels_test
