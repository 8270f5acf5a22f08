#include "reference_paths.hpp"

#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::collision {
namespace {

constexpr double skin_fraction = 0.4; // of the mean radius

// Statistics of the radii, and the first particle with bad elements.
struct RadiiTotal {
  double sum = 0.0, min = HUGE_VAL;
  std::size_t not_finite = ~std::size_t{0};
  void operator+=(const RadiiTotal& other) {
    sum += other.sum;
    min = std::min(min, other.min);
    not_finite = std::min(not_finite, other.not_finite);
  }
};

} // namespace

bool ReferencePaths::rebuild(const SearchContext& step, int lifetime, std::vector<Line>& buffer) {
  assert(lifetime > 0);
  lifetime_ = {0, lifetime};
  const auto& bodies = step.particles.bodies;
  const std::size_t count = bodies.size();
  buffer.resize(count + kernel_padding);
  lines_.resize(count + kernel_padding);
  if (mean_radius_ == 0.0) { // the first time
    const double sum = ordered_sum(count, [&](std::size_t k) { return bodies[k].radius; });
    mean_radius_ = sum / static_cast<double>(std::max<std::size_t>(1, count));
    min_radius_ = mean_radius_;
  }
  skin_ = skin_fraction * mean_radius_;
  const double half = lifetime_.half(step.step);
  const Instant at = step.instant(-lifetime_.since_middle(step.step));
  const Rotation middle(step.frequencies, at.after);
  const RadiiTotal radii = ordered_total<RadiiTotal>(count, [&](RadiiTotal& all, std::size_t k) {
    step.particles.prefetch_after(k);
    const Body& body = bodies[k];
    if (!is_finite(body.elements))
      all.not_finite = std::min(all.not_finite, k);
    all.sum += body.radius;
    all.min = std::min(all.min, body.radius);
    Line& line = buffer[k] = tangent_line(step, body, middle, skin_, half, at);
    line.tag = static_cast<std::uint32_t>(k);
    lines_[k] = line;
    line.size += rounding_of(line, half, step.box);
  });
  if (radii.not_finite < count)
    require_finite(step.particles, radii.not_finite);
  mean_radius_ = radii.sum / static_cast<double>(std::max<std::size_t>(1, count));
  min_radius_ = count ? radii.min : 0.0;
  cells_.build(std::span(buffer).first(count), step.box, at.offset, half, min_radius_ + skin_, folds_);
  return cells_.one_image();
}

bool ReferencePaths::renew(const SearchContext& step, std::size_t i, const Rotation& to_middle) {
  assert(i < step.particles.size() && !lifetime_.over());
  const Instant middle_of_all = step.instant(-lifetime_.since_middle(step.step));
  Line line =
      tangent_line(step, step.particles.bodies[i], to_middle, skin_, lifetime_.half_rest(step.step), middle_of_all);
  lines_[i] = line;
  line.size += rounding_of(line, lifetime_.half(step.step), step.box);
  cells_.replace(i, line);
  return cells_.one_image(line);
}

std::span<const std::uint32_t> ReferencePaths::find_neighbours(const SearchContext& step, std::size_t i,
                                                               std::vector<std::uint32_t>& buffer,
                                                               std::uint64_t& tested) const {
  const double half = lifetime_.half(step.step);
  const LineSpan rest = widened(lifetime_.since_middle(step.step) - 0.5 * step.step, half, half);
  const std::size_t count = cells_.find_near(cells_.line(i), rest, buffer, tested);
  for (std::size_t n = 0; n < count; ++n)
    buffer[n] = cells_.particle(buffer[n]);
  return std::span(buffer).first(count);
}

bool ReferencePaths::sound(std::size_t particles) const {
  if (lifetime_.age < 0 || lines_.size() != particles + kernel_padding || cells_.size() != particles || !cells_.sound())
    return false;
  for (std::size_t i = 0; i < particles; ++i) {
    const Line &line = lines_[i], &sorted = cells_.line(i);
    if (sorted.x != line.x || sorted.y != line.y || sorted.z != line.z || sorted.u != line.u || sorted.v != line.v ||
        sorted.w != line.w || !(sorted.size >= line.size))
      return false;
  }
  return true;
}

} // namespace keeler::collision
