#include <keeler/diagnostics/transmission.hpp>

#include <keeler/cells/sheared_cells.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

namespace keeler::diagnostics {
namespace {

// The shadow of a sphere on the plane z = 0: a Δx² + 2 b Δx Δy + c Δy² < r² about its centre.
class Shadow {
public:
  explicit Shadow(const LineOfSight& sight)
      : sine_(std::sin(sight.elevation)), tilt_x_(std::cos(sight.elevation) * std::cos(sight.azimuth) / sine_),
        tilt_y_(std::cos(sight.elevation) * std::sin(sight.azimuth) / sine_) {
    const double along_x = std::cos(sight.azimuth), along_y = std::sin(sight.azimuth), s2 = sine_ * sine_;
    a_ = s2 * along_x * along_x + along_y * along_y;
    b_ = (s2 - 1.0) * along_x * along_y;
    c_ = s2 * along_y * along_y + along_x * along_x;
  }

  void cast(const Vec3& centre, double radius) {
    x_ = centre.x() - tilt_x_ * centre.z();
    y_ = centre.y() - tilt_y_ * centre.z();
    radius2_ = radius * radius;
    half_x_ = radius * std::sqrt(c_) / sine_;
    top_dx_ = -b_ * radius / (std::sqrt(a_) * sine_);
  }

  double low_x() const { return x_ - half_x_; }
  double high_x() const { return x_ + half_x_; }

  // Returns the range of y of the shadow where 0 ≤ x − begin ≤ width.
  std::pair<double, double> rows(double begin, double width) const {
    const double from = std::max(begin - x_, -half_x_), to = std::min(begin + width - x_, half_x_);
    return {y_ - upper_edge(closest(-to, -from)), y_ + upper_edge(closest(from, to))};
  }

  bool covers(double x, double y) const {
    const double dx = x - x_, dy = y - y_;
    return a_ * dx * dx + 2.0 * b_ * dx * dy + c_ * dy * dy < radius2_;
  }

private:
  // Returns the edge with the larger y at Δx, relative to the centre; the other one is its reflection.
  double upper_edge(double dx) const {
    return (std::sqrt(std::max(0.0, c_ * radius2_ - sine_ * sine_ * dx * dx)) - b_ * dx) / c_;
  }

  // Returns the Δx where that edge is highest: it is concave with its top at top_dx_.
  double closest(double from, double to) const { return std::max(from, std::min(top_dx_, to)); }

  double sine_, tilt_x_, tilt_y_, a_ = 0, b_ = 0, c_ = 0;
  double x_ = 0, y_ = 0, radius2_ = 0, half_x_ = 0, top_dx_ = 0;
};

double at_least_one(double number) {
  return std::max(1.0, std::round(number));
}

} // namespace

RayLattice::RayLattice(const ShearingBox& box, std::size_t rays, double footprint, std::uint64_t seed) : box_(box) {
  assert(rays > 0 && footprint > 0.0 && box.area() > 0.0);
  const double across = at_least_one(box.size_x / footprint), along = at_least_one(box.size_y / footprint);
  const double side = std::sqrt(box.area() / static_cast<double>(rays)); // of a ray's cell
  const double columns = across * at_least_one(box.size_x / across / side),
               rows = along * at_least_one(box.size_y / along / side);
  // memory per ray: also two marks, and at most one footprint
  constexpr double bytes = sizeof(Position) + 2 * sizeof(std::uint8_t) + sizeof(double);
  positions_.resize(affordable_size(columns * rows, bytes,
                                    fmt::format("a lattice of {} rays, at least one in each footprint of {} m,",
                                                format_number(columns * rows, 4), format_number(footprint, 4)),
                                    "lower --rays or raise --footprint"));
  across_ = static_cast<std::size_t>(across), along_ = static_cast<std::size_t>(along);
  columns_ = static_cast<std::size_t>(columns), rows_ = static_cast<std::size_t>(rows);
  const double dx = box.size_x / static_cast<double>(columns_), dy = box.size_y / static_cast<double>(rows_);
  parallel_for(positions_.size(), [&](std::size_t k) {
    RandomStream random(seed, RandomPurpose::sample, k);
    const std::size_t column = k / rows_, row = k % rows_;
    positions_[k].x = -0.5 * box.size_x + (static_cast<double>(column) + random.uniform()) * dx;
    positions_[k].y = -0.5 * box.size_y + (static_cast<double>(row) + random.uniform()) * dy;
  });
}

std::vector<std::uint8_t> RayLattice::blocked(const Patch& patch, const LineOfSight& sight) const {
  assert(patch.box.size_x == box_.size_x && patch.box.size_y == box_.size_y);
  assert(std::sin(sight.elevation) > 0.0);
  const cells::ShearedCells cells{patch.box, patch.offset,
                                  cells::CellAxis(box_.size_x, box_.size_x / static_cast<double>(columns_), columns_),
                                  cells::CellAxis(box_.size_y, box_.size_y / static_cast<double>(rows_), rows_)};
  const double margin = 1e-9 * (box_.size_x + box_.size_y); // rounding may put a ray beside its cell
  std::vector<std::atomic<std::uint8_t>> marks(positions_.size());
  const Shadow plane(sight);
  parallel_for(
      patch.size(),
      [&](std::size_t k) {
        Shadow shadow = plane;
        shadow.cast(patch.positions[k], patch.radii[k]);
        const auto rows_at = [&](double begin) {
          const auto [low, high] = shadow.rows(begin - margin, cells.x.width + 2.0 * margin);
          return std::pair(low - margin, high + margin);
        };
        cells.visit_window(shadow.low_x() - margin, shadow.high_x() + margin, rows_at,
                           [&](std::size_t first, std::size_t last, const Image& image) {
                             const Vec3 shift = patch.box.displacement(image, patch.offset);
                             for (std::size_t ray = first; ray <= last; ++ray)
                               if (shadow.covers(positions_[ray].x + shift.x(), positions_[ray].y + shift.y()))
                                 marks[ray].store(1, std::memory_order_relaxed);
                           });
      },
      16);
  return {marks.begin(), marks.end()};
}

std::vector<double> RayLattice::transmissions(const std::vector<std::uint8_t>& blocked) const {
  assert(blocked.size() == size());
  const std::size_t block_columns = columns_ / across_, block_rows = rows_ / along_;
  std::vector<double> transmissions(footprints());
  parallel_for(transmissions.size(), [&](std::size_t f) {
    std::size_t passed = 0;
    for (std::size_t i = 0; i < block_columns; ++i)
      for (std::size_t j = 0; j < block_rows; ++j)
        passed += blocked[(f / along_ * block_columns + i) * rows_ + f % along_ * block_rows + j] == 0 ? 1 : 0;
    transmissions[f] = static_cast<double>(passed) / static_cast<double>(rays_per_footprint());
  });
  return transmissions;
}

// A ray in a cell with the transmission t has the variance t (1 − t). Half the squared difference of two neighbours has
// that mean, and slightly more if t differs between them.
RayMean ray_mean(const std::vector<std::uint8_t>& blocked) {
  assert(!blocked.empty());
  const auto rays = static_cast<double>(blocked.size());
  std::size_t passed = 0, differences = 0;
  for (std::size_t k = 0; k < blocked.size(); ++k) {
    passed += blocked[k] == 0 ? 1 : 0;
    differences += k % 2 == 1 && blocked[k] != blocked[k - 1] ? 1 : 0;
  }
  return {static_cast<double>(passed) / rays, std::sqrt(static_cast<double>(differences)) / rays};
}

} // namespace keeler::diagnostics
