// The straight lines of paths: references for the lists' life, lines for the window, and who leaves its slack.
#include "neighbour_lists.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr double slack_fraction = 0.4; // of the mean radius
constexpr double single = 4e-6;        // of a path: what single precision may do to a line

// A place as fractions of the box, in the cell: x first, so that the image is the one that x says.
struct Fractions {
  std::int32_t x, y;
  bool is_image; // of what stands outside of the cell
};
Fractions fractions(double x, double y, const ShearingBox& box, double offset) {
  const std::int64_t across = std::llrint(x * (full_turn / box.size_x));
  const std::int64_t boxes = (across + (std::int64_t{1} << 31)) >> 32;
  const std::int64_t along = std::llrint((y + static_cast<double>(boxes) * offset) * (full_turn / box.size_y));
  return {static_cast<std::int32_t>(static_cast<std::uint32_t>(across)),
          static_cast<std::int32_t>(static_cast<std::uint32_t>(along)),
          boxes != 0 || along >= std::int64_t{1} << 31 || along < -(std::int64_t{1} << 31)};
}

// The nearest whole number, without a call.
double nearest(double value) {
  constexpr double whole_numbers = 6755399441055744.0; // 1.5 · 2⁵²: doubles above it are whole numbers
  return (value + whole_numbers) - whole_numbers;
}

// The rounding of places, m.
double grain(const ShearingBox& box) {
  return 4.0 / full_turn * (box.size_x + box.size_y);
}

bool is_finite(const Elements& el) {
  return std::isfinite(el.guiding_x + el.guiding_y + el.e_cos + el.e_sin + el.i_sin + el.i_cos);
}

// Bound on the acceleration at all times.
double largest_acceleration(const Elements& el, const Frequencies& f) {
  return 2.0 * f.kappa * (std::fabs(el.e_cos) + std::fabs(el.e_sin)) +
         f.nu * f.nu * (std::fabs(el.i_sin) + std::fabs(el.i_cos));
}

} // namespace

Image NeighbourLists::nearest_image(const Body& a, const Body& b) const {
  const Elements el = b.elements - a.elements;
  const double x = el.guiding_x - el.e_cos, y = el.guiding_y + (2.0 / frequencies_.kappa) * el.e_sin;
  if (std::fabs(x) < 0.5 * box_.size_x && std::fabs(y) < 0.5 * box_.size_y)
    return {};
  return box_.image_into_cell(x, y, offset_);
}

// The way from this epoch to the middle of the window.
void NeighbourLists::look_to_window() {
  at_window_ = instant(-since_window());
  to_window_ = Rotation(frequencies_, at_window_.after);
}

void NeighbourLists::set_window(int length) {
  window_ = length;
  window_age_ = 0;
  look_to_window();
  const Rotation& r = to_window_;
  follow_ = {.kappa = frequencies_.kappa,
             .nu = frequencies_.nu,
             .shear = box_.shear,
             .after = r.after,
             .cos_e = r.cos_e,
             .sin_e = r.sin_e,
             .cos_i = r.cos_i,
             .sin_i = r.sin_i,
             .size_x = box_.size_x,
             .per_metre_x = full_turn / box_.size_x,
             .per_metre_y = full_turn / box_.size_y,
             .offset = at_window_.offset * (full_turn / box_.size_y),
             .since = since_middle() + r.after,
             .half = half_window(),
             .allowance = grain(box_)};
  frame_ = {static_cast<float>(box_.size_x / full_turn), static_cast<float>(box_.size_y / full_turn),
            static_cast<float>(box_.shear), fractions(0.0, at_window_.offset, box_, 0.0).y};
}

NeighbourLists::Instant NeighbourLists::instant(double after) const {
  return {after, std::fmod(offset_ + box_.shear * box_.size_x * after, box_.size_y)};
}

// The straight line that touches the path at a time after this epoch, as it stands at an instant. `size` is the
// radius and what curvature and the margin add in `half` before and after the touch.
Line NeighbourLists::line_of(const Body& body, const Rotation& tangent, double margin, double half,
                             const Instant& at) const {
  const State s = state_at(body.elements, frequencies_, tangent);
  const Vec3 p = s.position + (at.after - tangent.after) * s.velocity;
  const double curved = 0.5 * half * half * largest_acceleration(body.elements, frequencies_);
  const auto [x, y, is_image] = fractions(p.x(), p.y(), box_, at.offset);
  return {x,
          y,
          static_cast<float>(p.z()),
          static_cast<float>(s.velocity.x()),
          static_cast<float>(s.velocity.y() + box_.shear * p.x()),
          static_cast<float>(s.velocity.z()),
          static_cast<float>(body.radius + margin + curved),
          is_image};
}

// What single precision may do to a line in so much time before and after its instant.
float NeighbourLists::rounding_of(const Line& line, double half) const {
  const double path = half * (std::fabs(line.u) + std::fabs(line.v) + std::fabs(line.w));
  return static_cast<float>(single * (line.size + path + std::fabs(line.z)) + grain(box_));
}

// All references, into the window's lines, which are not made yet.
void NeighbourLists::make_references() {
  const std::size_t count = particles_->size();
  lines_.resize(count + kernel_padding);
  references_.resize(count + kernel_padding);
  struct Radii {
    double sum = 0.0, least = HUGE_VAL;
    std::size_t broken = ~std::size_t{0};
    void operator+=(const Radii& other) {
      sum += other.sum;
      least = std::min(least, other.least);
      broken = std::min(broken, other.broken);
    }
  };
  if (mean_radius_ == 0.0) { // the first time
    const double sum = ordered_sum(count, [&](std::size_t k) { return particles_->bodies[k].radius; });
    mean_radius_ = sum / static_cast<double>(std::max<std::size_t>(1, count));
    min_radius_ = mean_radius_;
  }
  slack_ = slack_fraction * mean_radius_;
  const Instant at = instant(-since_middle());
  const Rotation middle(frequencies_, at.after);
  const Radii radii = ordered_total<Radii>(count, [&](Radii& all, std::size_t k) {
    particles_->prefetch_after(k);
    const Body& body = particles_->bodies[k];
    if (!is_finite(body.elements))
      all.broken = std::min(all.broken, k);
    all.sum += body.radius;
    all.least = std::min(all.least, body.radius);
    Line& line = lines_[k] = line_of(body, middle, slack_, half_life(), at);
    line.place = static_cast<std::uint32_t>(k);
    references_[k] = line;
    line.size += rounding_of(line, half_life());
  });
  if (radii.broken < count)
    throw InvariantError(fmt::format("particle {} has elements that are not finite", particles_->ids[radii.broken]));
  mean_radius_ = radii.sum / static_cast<double>(std::max<std::size_t>(1, count));
  min_radius_ = count ? radii.least : 0.0;
}

// The lines of the window, and who may leave its slack in it.
void NeighbourLists::follow(std::vector<std::uint32_t>& leavers) {
  constexpr std::size_t chunk = 4096;
  const std::size_t count = particles_->size();
  std::vector<std::vector<std::uint32_t>> found((count + chunk - 1) / chunk);
  parallel_for(
      found.size(),
      [&](std::size_t b) {
        std::uint32_t buffer[chunk];
        const std::size_t begin = b * chunk, end = std::min(count, begin + chunk);
        const double* const rows = &particles_->bodies[0].elements.guiding_x;
        const std::size_t leaving =
            kernels_.follow(rows, references_.data(), follow_, begin, end, lines_.data(), buffer);
        found[b].assign(buffer, buffer + leaving);
      },
      1);
  for (const std::vector<std::uint32_t>& some : found)
    leavers.insert(leavers.end(), some.begin(), some.end());
}

// A new reference: the line of its present path about the middle of what is left. False: nearest images will not do.
bool NeighbourLists::refer_anew(std::size_t i, const Rotation& to_middle) {
  const Body& body = particles_->bodies[i];
  if (!is_finite(body.elements))
    throw InvariantError(fmt::format("particle {} has elements that are not finite", particles_->ids[i]));
  ++times_anew_;
  ++listed_anew;
  mark(anew_, is_anew_, i);
  mark(touched_, is_touched_, i);
  Line line = line_of(body, to_middle, slack_, 0.5 * (life_ - age_) * step_, instant(-since_middle()));
  references_[i] = line;
  line.size += rounding_of(line, half_life());
  cells_.replace(i, line);
  return cells_.one_image(line);
}

bool NeighbourLists::changed(std::size_t i, double time) {
  const Body& body = particles_->bodies[i];
  Line& line = lines_[i];
  line = line_of(body, to_window_, 0.0, half_window(), at_window_);
  line.size += rounding_of(line, half_window());
  // how far from the reference in the middle of the window, and how fast it goes: a line in between
  const FollowFrame& f = follow_;
  const Line& r = references_[i];
  double dx = line.x - (r.x + r.u * f.since * f.per_metre_x);
  const double outward = nearest(dx * (1.0 / full_turn));
  dx -= outward * full_turn;
  const double along = r.v - f.shear * r.x * (f.size_x / full_turn);
  double dy = line.y + outward * f.offset - (r.y + along * f.since * f.per_metre_y);
  dy -= full_turn * nearest(dy * (1.0 / full_turn));
  const Vec3 off(dx * frame_.metres_x, dy * frame_.metres_y, line.z - (r.z + r.w * f.since));
  const Vec3 beyond(line.u - r.u, line.v - r.v - f.shear * (off.x() + f.since * r.u), line.w - r.w);
  const double limit = r.size - line.size - rounding_of(line, half_window());
  const auto within = [&](double when) { return limit >= 0.0 && (off + when * beyond).squaredNorm() <= limit * limit; };
  const double now = since_window();
  is_leaving_[i] = !within(half_window());
  return within(now + time) && (!is_leaving_[i] || within(now + 0.5 * step_));
}

} // namespace keeler
