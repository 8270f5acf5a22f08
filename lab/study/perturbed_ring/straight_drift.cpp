#include "straight_drift.hpp"

#include <keeler/core/error.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

constexpr std::uint32_t max_collisions = 100000; // per particle and step
constexpr double wider = 1.0 + 1e-9;             // covers the rounding of the search ranges

// Returns a line's speed relative to the shear flow at its mid-step position.
double peculiar_speed(const Vec3& mid_position, const Vec3& velocity, double shear) {
  return (velocity + Vec3(0.0, shear * mid_position.x(), 0.0)).norm();
}

// Returns the time until two approaching straight lines touch, infinite when they never do.
double time_to_contact(const State& relative, double radius_sum) {
  const double slope = relative.position.dot(relative.velocity);
  const double gap = relative.position.squaredNorm() - radius_sum * radius_sum;
  const double discriminant = slope * slope - relative.velocity.squaredNorm() * gap;
  if (slope >= 0.0 || discriminant < 0.0)
    return HUGE_VAL;
  return gap <= 0.0 ? 0.0 : gap / (-slope + std::sqrt(discriminant));
}

} // namespace

StraightDrift::StraightDrift(const collision::CollisionSettings& settings, const Frequencies& frequencies,
                             double orbital_frequency, double step)
    : settings_(settings), frequencies_(frequencies), orbital_frequency_(orbital_frequency), step_(step) {
  assert(step > 0.0);
}

std::uint64_t StraightDrift::collide(Particles& particles, const ShearingBox& box, double offset) {
  assert(particles.ids.size() == particles.size());
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  prepare();
  for (std::size_t i = 0; i < particles.size(); ++i)
    visit_candidates(i, [&](std::size_t j, const Image& image) {
      if (particles.ids[i] < particles.ids[j])
        predict(i, j, image);
    });
  std::uint64_t collisions = 0;
  while (!events_.empty()) {
    const collision::Event event = events_.take_first();
    if (event.low_count == event_counts_[event.low] && event.high_count == event_counts_[event.high])
      collisions += carry_out(event);
  }
  return collisions;
}

void StraightDrift::prepare() {
  const std::size_t count = particles_->size();
  lines_.resize(count);
  binned_.resize(count);
  event_counts_.assign(count, 0);
  events_.assign({});
  largest_radius_ = largest_speed_ = largest_stray_ = 0.0;
  const Rotation start(frequencies_, -0.5 * step_);
  for (std::size_t k = 0; k < count; ++k) {
    const State state = state_at(particles_->bodies[k].elements, frequencies_, start);
    binned_[k] = state.position + 0.5 * step_ * state.velocity;
    follow(k, state, -0.5 * step_);
    largest_radius_ = std::max(largest_radius_, particles_->bodies[k].radius);
  }
  grid_.build(binned_, box_, offset_, 2.0 * largest_radius_ + step_ * largest_speed_);
}

// Starts a new line for particle i and widens the ranges of later searches to cover it.
void StraightDrift::follow(std::size_t i, const State& state, double since) {
  lines_[i] = {state.position, state.velocity, since};
  const Vec3 mid_position = lines_[i].at(0.0);
  largest_speed_ = std::max(largest_speed_, peculiar_speed(mid_position, state.velocity, box_.shear));
  largest_stray_ = std::max(largest_stray_, (mid_position - binned_[i]).cwiseAbs().maxCoeff());
}

// Calls visit(j, image) for every particle image that particle i could touch within the step: relative to mid-step,
// coordinates change by at most half a step times the relative speed, the shear between the two included.
template<class Visit> void StraightDrift::visit_candidates(std::size_t i, const Visit& visit) const {
  const double half = 0.5 * step_;
  const Vec3 position = lines_[i].at(0.0);
  const double speed = peculiar_speed(position, lines_[i].velocity, box_.shear) + largest_speed_;
  const double contact = particles_->bodies[i].radius + largest_radius_;
  const double reach_x = contact + half * speed;
  const double reach_y = contact + half * (speed + box_.shear * reach_x);
  const double stray = largest_stray_ + 1e-12 * (box_.size_x + box_.size_y);
  grid_.visit_near(position, wider * reach_x + stray, wider * reach_y + stray, [&](std::size_t j, const Image& image) {
    if (j != i)
      visit(j, image);
  });
}

// Returns displacement and velocity of an image relative to its particle: columns of images slide with the shear.
State StraightDrift::image_state(const Image& image, double time) const {
  const double slide = image.nx * box_.shear * box_.size_x;
  return {box_.displacement(image, offset_) - Vec3(0.0, slide * time, 0.0), Vec3(0.0, -slide, 0.0)};
}

// Adds the contact of particle i with this image of particle j, if they touch within the step.
void StraightDrift::predict(std::size_t i, std::size_t j, const Image& image) {
  const bool ordered = particles_->ids[i] < particles_->ids[j];
  const std::size_t low = ordered ? i : j, high = ordered ? j : i;
  const Image of_high = ordered ? image : -image;
  const Line &a = lines_[low], &b = lines_[high];
  const double start = std::max(a.since, b.since);
  const State shift = image_state(of_high, start);
  const State relative{b.at(start) + shift.position - a.at(start), b.velocity + shift.velocity - a.velocity};
  const double radius_sum = particles_->bodies[low].radius + particles_->bodies[high].radius;
  const double time = start + time_to_contact(relative, radius_sum);
  if (time < 0.5 * step_)
    events_.add({time, particles_->ids[low], particles_->ids[high], of_high, static_cast<std::uint32_t>(low),
                 static_cast<std::uint32_t>(high), event_counts_[low], event_counts_[high]});
}

// Carries out a contact with positions from the lines and velocities from the epicycles; the new epicycles match both.
// Returns false if the particles do not approach.
bool StraightDrift::carry_out(const collision::Event& event) {
  Body &a = particles_->bodies[event.low], &b = particles_->bodies[event.high];
  const Rotation rotation(frequencies_, event.time);
  State of_a{lines_[event.low].at(event.time), state_at(a.elements, frequencies_, rotation).velocity};
  State of_b{lines_[event.high].at(event.time), state_at(b.elements, frequencies_, rotation).velocity};
  const State shift = image_state(event.image, event.time);
  const Vec3 normal = (of_b.position + shift.position - of_a.position).normalized();
  const double speed = -(of_b.velocity + shift.velocity - of_a.velocity).dot(normal);
  const collision::Rebound after = rebound(settings_, speed, a.radius, b.radius, orbital_frequency_);
  if (!(speed > -after.speed))
    return false; // the lines approach but the particles do not
  const Vec3 impulse = a.mass * b.mass / (a.mass + b.mass) * (speed + after.speed) * normal;
  of_a.velocity -= impulse / a.mass;
  of_b.velocity += impulse / b.mass;
  a.elements = elements_from(of_a, frequencies_, rotation);
  b.elements = elements_from(of_b, frequencies_, rotation);
  follow(event.low, of_a, event.time);
  follow(event.high, of_b, event.time);
  if (++event_counts_[event.low] > max_collisions || ++event_counts_[event.high] > max_collisions)
    throw InvariantError("a particle collided more than 100000 times in one step on straight lines");

  visit_candidates(event.low, [&](std::size_t k, const Image& image) { predict(event.low, k, image); });
  visit_candidates(event.high, [&](std::size_t k, const Image& image) {
    if (k != event.low) // the search of event.low covered this pair with all images
      predict(event.high, k, image);
  });
  return true;
}

} // namespace keeler::study
