#include "path_lines.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::collision {
namespace {

constexpr double single_precision = 4e-6; // relative bound on the rounding of a line

// A position as fractions of the box, in the cell: x first, so that the image is the one that x gives.
struct Fractions {
  std::int32_t x, y;
  bool is_image; // the position itself is outside the cell
};
Fractions fractions(double x, double y, const ShearingBox& box, double offset) {
  const std::int64_t across = std::llrint(x * (full_turn / box.size_x));
  const std::int64_t boxes = (across + (std::int64_t{1} << 31)) >> 32;
  const std::int64_t along = std::llrint((y + static_cast<double>(boxes) * offset) * (full_turn / box.size_y));
  return {static_cast<std::int32_t>(static_cast<std::uint32_t>(across)),
          static_cast<std::int32_t>(static_cast<std::uint32_t>(along)),
          boxes != 0 || along >= std::int64_t{1} << 31 || along < -(std::int64_t{1} << 31)};
}

// Rounds to the nearest integer without a call.
double nearest_integer(double value) {
  constexpr double whole_numbers = 6755399441055744.0; // 1.5 · 2⁵²: doubles above it are integers
  return (value + whole_numbers) - whole_numbers;
}

// Bound on the acceleration at all times.
double max_acceleration(const Elements& el, const Frequencies& f) {
  return 2.0 * f.kappa * (std::fabs(el.e_cos) + std::fabs(el.e_sin)) +
         f.nu * f.nu * (std::fabs(el.i_sin) + std::fabs(el.i_cos));
}

} // namespace

bool is_finite(const Elements& el) {
  return std::isfinite(el.guiding_x + el.guiding_y + el.e_cos + el.e_sin + el.i_sin + el.i_cos);
}

void require_finite(const Particles& particles, std::size_t i) {
  if (!is_finite(particles.bodies[i].elements))
    throw InvariantError(fmt::format("particle {} has elements that are not finite", particles.ids[i]));
}

Line tangent_line(const SearchContext& step, const Body& body, const Rotation& tangent, double margin, double half,
                  const Instant& at) {
  const State s = state_at(body.elements, step.frequencies, tangent);
  const Vec3 p = s.position + (at.after - tangent.after) * s.velocity;
  const double curved = 0.5 * half * half * max_acceleration(body.elements, step.frequencies);
  const auto [x, y, is_image] = fractions(p.x(), p.y(), step.box, at.offset);
  return {x,
          y,
          static_cast<float>(p.z()),
          static_cast<float>(s.velocity.x()),
          static_cast<float>(s.velocity.y() + step.box.shear * p.x()),
          static_cast<float>(s.velocity.z()),
          static_cast<float>(body.radius + margin + curved),
          is_image};
}

float rounding_of(const Line& line, double half, const ShearingBox& box) {
  const double path = half * (std::fabs(line.u) + std::fabs(line.v) + std::fabs(line.w));
  return static_cast<float>(single_precision * (line.size + path + std::fabs(line.z)) + position_rounding(box));
}

LineFrame line_frame(const ShearingBox& box, const Instant& at) {
  assert(box.size_x > 0.0 && box.size_y > 0.0);
  return {static_cast<float>(box.size_x / full_turn), static_cast<float>(box.size_y / full_turn),
          static_cast<float>(box.shear), fractions(0.0, at.offset, box, 0.0).y};
}

FollowFrame follow_frame(const SearchContext& step, const Rotation& middle, const Instant& at, double since,
                         double half) {
  assert(middle.after == at.after && half > 0.0);
  return {.kappa = step.frequencies.kappa,
          .nu = step.frequencies.nu,
          .shear = step.box.shear,
          .after = middle.after,
          .cos_e = middle.cos_e,
          .sin_e = middle.sin_e,
          .cos_i = middle.cos_i,
          .sin_i = middle.sin_i,
          .size_x = step.box.size_x,
          .per_metre_x = full_turn / step.box.size_x,
          .per_metre_y = full_turn / step.box.size_y,
          .offset = at.offset * (full_turn / step.box.size_y),
          .since = since,
          .half = half,
          .allowance = position_rounding(step.box)};
}

PathOffset offset_from(const Line& reference, const Line& line, const FollowFrame& f, const LineFrame& frame) {
  const Line& r = reference;
  double dx = line.x - (r.x + r.u * f.since * f.per_metre_x);
  const double outward = nearest_integer(dx * (1.0 / full_turn));
  dx -= outward * full_turn;
  const double along = r.v - f.shear * r.x * (f.size_x / full_turn);
  double dy = line.y + outward * f.offset - (r.y + along * f.since * f.per_metre_y);
  dy -= full_turn * nearest_integer(dy * (1.0 / full_turn));
  const Vec3 off(dx * frame.metres_x, dy * frame.metres_y, line.z - (r.z + r.w * f.since));
  const Vec3 rate(line.u - r.u, line.v - r.v - f.shear * (off.x() + f.since * r.u), line.w - r.w);
  return {off, rate};
}

} // namespace keeler::collision
