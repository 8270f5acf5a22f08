// Blocks of targets and lists of sources for tests of kernels, and the plain loop that kernels must equal.
#pragma once

#include "single.hpp"

#include <keeler/core/random.hpp>

#include <cmath>
#include <vector>

namespace keeler_test {

using namespace keeler;
using namespace keeler::gravity;

struct Point {
  double x, y, z;
};

inline TargetBlock targets_at(const std::vector<Point>& points) {
  TargetBlock targets{};
  for (std::size_t k = 0; k < points.size(); ++k) {
    targets.x[k] = points[k].x;
    targets.y[k] = points[k].y;
    targets.z[k] = points[k].z;
  }
  return targets;
}

/// Returns the targets in single precision, with the origin at (0, 0, 0).
inline SingleTargetBlock in_single(const TargetBlock& from) {
  SingleTargetBlock targets{};
  for (std::size_t k = 0; k < TargetBlock::capacity; ++k) {
    split_position(from.x[k], targets.x[k], targets.x_low[k]);
    split_position(from.y[k], targets.y[k], targets.y_low[k]);
    split_position(from.z[k], targets.z[k], targets.z_low[k]);
    targets.from_x[k] = static_cast<float>(from.x[k]);
    targets.from_y[k] = static_cast<float>(from.y[k]);
    targets.from_z[k] = static_cast<float>(from.z[k]);
  }
  return targets;
}

inline SingleTargetBlock single_targets_at(const std::vector<Point>& points) {
  return in_single(targets_at(points));
}

inline std::vector<SinglePoint> in_single(const std::vector<PointSource>& sources) {
  std::vector<SinglePoint> points;
  for (const PointSource& s : sources)
    points.push_back(single_point(s));
  return points;
}

/// Returns sources within a few units of the origin.
inline TargetBlock random_targets() {
  RandomStream random(11, RandomPurpose::position, 0);
  std::vector<Point> points;
  for (std::size_t k = 0; k < TargetBlock::capacity; ++k)
    points.push_back({random.normal(), random.normal(), random.normal()});
  return targets_at(points);
}

inline std::vector<PointSource> random_points(std::size_t count) {
  RandomStream random(14, RandomPurpose::position, 0);
  std::vector<PointSource> points;
  for (std::size_t k = 0; k < count; ++k)
    points.push_back({10.0 * random.normal(), 10.0 * random.normal(), 10.0 * random.normal(), random.uniform()});
  return points;
}

/// Returns cells 10 units from the origin, with quadrupoles of the size of their masses.
inline std::vector<CellSource> random_cells(std::size_t count) {
  RandomStream random(12, RandomPurpose::position, 0);
  const auto normal = [&] { return static_cast<float>(random.normal()); };
  std::vector<CellSource> cells;
  for (std::size_t k = 0; k < count; ++k) {
    CellSource c{10.0F + normal(), normal(), normal(), static_cast<float>(random.uniform()), normal(), normal(), 0.0F,
                 normal(),         normal(), normal()};
    c.zz = -c.xx - c.yy;
    cells.push_back(c);
  }
  return cells;
}

/// Returns the cells as a list for a local expansion about the origin.
inline FarCells far_cells(const std::vector<CellSource>& cells) {
  FarCells far{};
  for (float& x : far.x)
    x = 1.0F;
  for (std::size_t k = 0; k < cells.size(); ++k)
    put(far, k, cells[k]);
  return far;
}

/// Returns the sums that the kernel `points` must compute.
inline TargetBlock plain_sum(const TargetBlock& from, std::size_t count, const std::vector<PointSource>& sources) {
  TargetBlock targets = from;
  for (std::size_t k = 0; k < count; ++k) {
    long double sum[3] = {0, 0, 0};
    for (const PointSource& s : sources) {
      const long double d[3] = {static_cast<long double>(s.x) - targets.x[k],
                                static_cast<long double>(s.y) - targets.y[k],
                                static_cast<long double>(s.z) - targets.z[k]};
      const long double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      for (int axis = 0; axis < 3 && d2 > 0; ++axis)
        sum[axis] += s.mass * d[axis] / (d2 * std::sqrt(d2));
    }
    targets.ax[k] = static_cast<double>(sum[0]);
    targets.ay[k] = static_cast<double>(sum[1]);
    targets.az[k] = static_cast<double>(sum[2]);
  }
  return targets;
}

} // namespace keeler_test
