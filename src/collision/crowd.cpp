#include "crowd.hpp"

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr double margin_share = 1e-4;       // of the radius
constexpr double single = 4e-6;             // of a path: what single precision may do to a line
constexpr double half_range = 2147483648.0; // 2³¹: a place in integers, as far as the box is long

} // namespace

void Crowd::begin(const StepAtHand& step, std::uint32_t centre) {
  step_ = &step;
  centre_ = centre;
  then_ = step.particles->bodies[centre];
  half_step_ = -step.begin;
  margin_ = margin_share * then_.radius;
  const auto metres = static_cast<float>(std::max(step.box.size_x, step.box.size_y) / half_range);
  frame_ = {metres, metres, 0.0f, 0};
  lines_.clear();
}

// Who stays away is not taken. An older line of it may stay behind: one more to be tested, no more.
void Crowd::take(std::uint32_t place) {
  const Frequencies& f = step_->frequencies;
  const ShearingBox& box = step_->box;
  const Body& other = step_->particles->bodies[place];
  Elements el = other.elements - then_.elements;
  const Vec3 now = state_at(el, f, Rotation()).position;
  el = box.image_of(el, box.image_into_cell(now.x(), now.y(), step_->offset), step_->offset);
  const State s = state_at(el, f, Rotation());
  const double acceleration = 2.0 * f.kappa * el.eccentricity() + f.nu * f.nu * el.inclination();
  // with everything that brings the two closer than their lines
  const double size = other.radius + then_.radius + 0.5 * acceleration * half_step_ * half_step_ + margin_;
  const double path = half_step_ * s.velocity.lpNorm<1>(), metres = frame_.metres_x;
  const double rounding = single * (size + path + std::fabs(s.position.z())) + 4.0 * metres;
  const double farthest = 1.00001 * (size + path + rounding);
  if (s.position.squaredNorm() > farthest * farthest)
    return;
  const Line line{static_cast<std::int32_t>(std::llrint(s.position.x() / metres)),
                  static_cast<std::int32_t>(std::llrint(s.position.y() / metres)),
                  static_cast<float>(s.position.z()),
                  static_cast<float>(s.velocity.x()),
                  static_cast<float>(s.velocity.y()),
                  static_cast<float>(s.velocity.z()),
                  static_cast<float>(size + rounding),
                  place};
  const auto known = std::find_if(lines_.begin(), lines_.end(), [&](const Line& l) { return l.place == place; });
  if (known == lines_.end())
    lines_.push_back(line);
  else
    *known = line;
}

Crowd* Crowds::of(std::uint32_t centre) {
  for (std::size_t k = 0; k < count_; ++k)
    if (crowds_[k].centre() == centre)
      return &crowds_[k];
  return nullptr;
}

Crowd* Crowds::add(const StepAtHand& step, std::uint32_t centre) {
  if (count_ == most)
    return nullptr;
  if (crowds_.size() == count_)
    crowds_.emplace_back();
  Crowd& crowd = crowds_[count_++];
  crowd.begin(step, centre);
  return &crowd;
}

void Crowds::drop(const Crowd* crowd) {
  std::swap(crowds_[static_cast<std::size_t>(crowd - crowds_.data())], crowds_[--count_]);
}

std::size_t Crowds::bytes() const {
  std::size_t total = 0;
  for (const Crowd& crowd : crowds_)
    total += sizeof crowd + crowd.bytes();
  return total;
}

} // namespace keeler
