#include "ghost_layer.hpp"

#include <algorithm>
#include <cmath>

namespace keeler::decomposition {
namespace {

constexpr double aspect = 2.0; // of margins along y and x

// Returns the difference of two coordinates through the nearest image.
double nearest(double difference, double size) {
  return std::fabs(difference) > 0.5 * size ? difference - size * std::floor(difference / size + 0.5) : difference;
}

} // namespace

double GhostLayer::excursion(const Point& reference, const Elements& el) const {
  const Point now = position(el);
  const double across = now.x - reference.x, x = nearest(across, box.size_x), e = el.eccentricity();
  const double distance = std::fabs(x) + 0.5 * epoch.step * kappa * e; // |ẋ| ≤ κ e
  if (!has_rows)
    return distance;
  // the image at x + reference.x; the velocity of the path against the reference is at most 2 e + S |X − reference.x|
  const double boxes = x == across ? 0.0 : std::round((across - x) / box.size_x),
               reference_y = reference.y - box.shear * reference.x * (epoch.time - built_at),
               y = nearest(now.y + boxes * epoch.offset - reference_y, box.size_y),
               shear = box.shear * std::fabs(el.guiding_x - boxes * box.size_x - reference.x);
  return std::max(distance, (std::fabs(y) + 0.5 * epoch.step * (2.0 * e + shear)) / aspect);
}

Point GhostLayer::near_reach(double max_radius, double lifetime) const {
  constexpr double rounding = 1e-9; // of references, too
  const double x = 2.0 * margin + 2.0 * max_radius,
               y = 2.0 * aspect * margin + 2.0 * max_radius + box.shear * x * lifetime,
               more = rounding * (box.size_x + box.size_y);
  return {x * (1.0 + rounding) + more, y * (1.0 + rounding) + more};
}

} // namespace keeler::decomposition
