#include "sphere_cell.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler::light {
namespace {

constexpr double single_rounding = 0x1p-24; // relative, half a unit in the last place

} // namespace

SphereCell::SphereCell(const Patch& patch) : box_(patch.box), offset_(patch.offset) {
  assert(patch.size() > 0 && patch.size() <= std::numeric_limits<std::uint32_t>::max());
  bottom_ = std::numeric_limits<double>::infinity(), top_ = -bottom_;
  double largest = 0.0;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    bottom_ = std::min(bottom_, patch.positions[k].z() - patch.radii[k]);
    top_ = std::max(top_, patch.positions[k].z() + patch.radii[k]);
    largest = std::max(largest, patch.radii[k]);
  }
  const double extent = std::max({box_.size_x, box_.size_y, top_ - bottom_, std::fabs(top_), std::fabs(bottom_)});
  margin_ = 4.0 * single_rounding * (extent + 2.0 * largest);
  const double half_x = 0.5 * box_.size_x, half_y = 0.5 * box_.size_y;
  spheres_.reserve(patch.size() + patch.size() / 8);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3& p = patch.positions[k];
    const double reach = patch.radii[k] + margin_;
    const auto first = [reach](double half, double at, double size) {
      return static_cast<std::int32_t>(std::ceil((-half - reach - at) / size));
    };
    const auto last = [reach](double half, double at, double size) {
      return static_cast<std::int32_t>(std::floor((half + reach - at) / size));
    };
    for (std::int32_t nx = first(half_x, p.x(), box_.size_x); nx <= last(half_x, p.x(), box_.size_x); ++nx) {
      const double y = p.y() - nx * offset_;
      for (std::int32_t ny = first(half_y, y, box_.size_y); ny <= last(half_y, y, box_.size_y); ++ny)
        spheres_.push_back({p + box_.displacement({nx, ny}, offset_), patch.radii[k], static_cast<std::uint32_t>(k)});
    }
  }
}

Vec3 SphereCell::inside(Vec3 point) const {
  const double nx = std::floor(point.x() / box_.size_x + 0.5);
  point.x() -= nx * box_.size_x;
  point.y() += nx * offset_;
  point.y() -= std::floor(point.y() / box_.size_y + 0.5) * box_.size_y;
  return point;
}

double SphereCell::way_out(const Vec3& point, const Vec3& direction, bool& leaves_layer) const {
  const auto until = [](double at, double speed, double low, double high) {
    return speed > 0.0   ? std::max(0.0, (high - at) / speed)
           : speed < 0.0 ? std::max(0.0, (low - at) / speed)
                         : std::numeric_limits<double>::infinity();
  };
  const double half_x = 0.5 * box_.size_x, half_y = 0.5 * box_.size_y;
  const double in_cell =
      std::min(until(point.x(), direction.x(), -half_x, half_x), until(point.y(), direction.y(), -half_y, half_y));
  const double in_layer = until(point.z(), direction.z(), bottom_, top_);
  leaves_layer = in_layer <= in_cell;
  return std::min(in_layer, in_cell);
}

Vec3 SphereCell::across(const Vec3& point, const Vec3& direction, double way) const {
  const double half_x = 0.5 * box_.size_x, half_y = 0.5 * box_.size_y;
  Vec3 next = point + way * direction;
  // Rounding may leave the point just inside the face that it reached, where it would be stuck.
  const double beyond = 1e-12 * (box_.size_x + box_.size_y);
  if (std::fabs(next.x()) > half_x - beyond && next.x() * direction.x() > 0.0) {
    const double side = std::copysign(1.0, next.x());
    next.x() = -side * half_x;
    next.y() += side * offset_;
    next.y() -= std::floor(next.y() / box_.size_y + 0.5) * box_.size_y;
  }
  if (std::fabs(next.y()) > half_y - beyond && next.y() * direction.y() > 0.0)
    next.y() = -std::copysign(half_y, next.y());
  return next;
}

double single_precision_bound(const SphereCell& cell) {
  return 2.0 * single_rounding * (cell.box().size_x + cell.box().size_y + cell.top() - cell.bottom());
}

} // namespace keeler::light
