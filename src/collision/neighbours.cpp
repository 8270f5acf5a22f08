#include <keeler/collision/neighbours.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

namespace keeler {
namespace {

constexpr int longest_window = 12;     // steps
constexpr double window_path = 0.3;    // of a mean radius: what two particles may approach by in a window, on average
constexpr double window_hits = 0.3;    // of a particle in a window: more, and lists are remade too often
constexpr double fewest_reaches = 2.2; // that must fit into the box for the nearest image to be the only one

} // namespace

double Neighbours::reach_x(double eccentricity, double contact, double time) const {
  return contact + time * frequencies_.kappa * eccentricity;
}

double Neighbours::reach_y(double eccentricity, double contact, double time) const {
  const double guiding = reach_x(eccentricity, contact, time) + eccentricity;
  return contact + time * (frequencies_.shear() * guiding + 2.0 * eccentricity);
}

Image Neighbours::nearest_image(std::size_t i, std::size_t j) const {
  const Elements el = particles_->bodies[j].elements - particles_->bodies[i].elements;
  const double x = el.guiding_x - el.e_cos, y = el.guiding_y + (2.0 / frequencies_.kappa) * el.e_sin;
  if (std::fabs(x) < 0.5 * box_.size_x && std::fabs(y) < 0.5 * box_.size_y)
    return {};
  return box_.image_into_cell(x, y, offset_);
}

bool Neighbours::may_touch(const StraightLineTest& test, std::size_t i, std::size_t j, const Image& image,
                           double start) const {
  const Vec3 shift = box_.displacement(image, offset_);
  return test.may_touch(particles_->bodies[i], particles_->bodies[j], shift.x(), shift.y(), start);
}

void Neighbours::begin(const Particles& particles, const ShearingBox& box, double offset) {
  const bool same = particles_ == &particles && binned_.size() == particles.size();
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  ++at_step_;
  if (!(goes_on_ && same && at_step_ < length_ && kick_path_ <= skin_))
    open();
  goes_on_ = false;
  const double size = box_.size_x + box_.size_y, half = 0.5 * step_, left = window_end() - since_open();
  step_test_ = {frequencies_, half, half, 1e-13 * size};
  window_test_ = {frequencies_, left, std::max(left, half), 2.0 * skin_ + 1e-13 * size};
}

// The path of a kicked particle departs from its old one by at most |Δv| (t + t²) in a time t < 1.
void Neighbours::kicked(double largest) {
  const double time = length_ * step_;
  last_kick_ = largest;
  kick_path_ += largest * time * (1.0 + time);
  largest_eccentricity_ += 2.0 / (frequencies_.kappa * frequencies_.kappa) * largest * (1.0 + 1e-9);
}

void Neighbours::changed(std::size_t i) {
  const Elements& el = particles_->bodies[i].elements;
  const State then = state_at(el, frequencies_, Rotation(frequencies_, -since_open()));
  if (!(then.position.allFinite() && then.velocity.allFinite()))
    throw InvariantError(
        fmt::format("a collision left particle {} with elements that are not finite", particles_->ids[i]));
  ++changes_[i];
  ++hits_;
  Vec3 stray = then.position - binned_[i];
  if (at_step_ > 0) { // the particle may have been wrapped since
    const double offset = offset_ - box_.shear * box_.size_x * since_open();
    stray += box_.displacement(box_.image_into_cell(stray.x(), stray.y(), offset), offset);
  }
  largest_eccentricity_ = std::max(largest_eccentricity_, el.eccentricity());
  largest_stray_ = std::max(largest_stray_, stray.cwiseAbs().maxCoeff());
}

int Neighbours::length_for(double mean_eccentricity, double mean_radius) const {
  const double steps_done = std::max(1, at_step_) * static_cast<double>(std::max<std::size_t>(1, binned_.size()));
  const double hits = static_cast<double>(hits_) / steps_done; // of a particle in a step of the last window
  const double by_path = window_path * mean_radius / (2.0 * mean_eccentricity * step_);
  const double by_hits = window_hits / hits;
  return static_cast<int>(std::clamp(std::min(by_path, by_hits), 1.0, static_cast<double>(longest_window)));
}

void Neighbours::open() {
  const std::size_t count = particles_->size();
  binned_.resize(count);
  static const Rotation at_epoch;
  parallel_for(count, [&](std::size_t k) {
    binned_[k] = state_at(particles_->bodies[k].elements, frequencies_, at_epoch).position;
  });
  largest_radius_ = largest_eccentricity_ = largest_stray_ = 0.0;
  double eccentricities = 0.0, radii = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const Body& body = particles_->bodies[k];
    const double e = body.elements.eccentricity();
    if (!(std::isfinite(e) && std::isfinite(body.elements.i_cos) && binned_[k].allFinite()))
      throw InvariantError(fmt::format("particle {} has elements that are not finite", particles_->ids[k]));
    largest_radius_ = std::max(largest_radius_, body.radius);
    largest_eccentricity_ = std::max(largest_eccentricity_, e);
    eccentricities += e, radii += body.radius;
  }
  const double number = static_cast<double>(count) + 1e-9;
  length_ = every_candidate ? 1 : length_for(eccentricities / number, radii / number);
  at_step_ = 0;
  hits_ = 0;

  plain_eccentricity_ = 4.0 * (largest_eccentricity_ + largest_radius_);
  const double e = plain_eccentricity_ + largest_eccentricity_;
  const double far =
      std::max(reach_x(e, 2.0 * largest_radius_, window_end()), reach_y(e, 2.0 * largest_radius_, window_end()));
  listed_ = length_ > 1 && std::min(box_.size_x, box_.size_y) > fewest_reaches * far;
  if (!listed_)
    length_ = 1;
  skin_ = listed_ ? 2.6 * last_kick_ * length_ * length_ * step_ * (1.0 + length_ * step_) : 0.0;
  kick_path_ = 0.0;

  const double cell = 2.0 * largest_radius_ + 2.0 * std::max(window_end(), 0.5 * step_) * largest_eccentricity_;
  grid_.build(binned_, box_, offset_, cell);
  added_.clear();
  changes_.assign(count, 0);
  if (listed_)
    list_pairs();
}

void Neighbours::list_pairs() {
  const StraightLineTest test{frequencies_, window_end(), window_end(),
                              2.0 * skin_ + 1e-13 * (box_.size_x + box_.size_y)};
  lists_.resize((binned_.size() + block_size - 1) / block_size);
  parallel_for(
      lists_.size(),
      [&](std::size_t b) {
        lists_[b].clear();
        for (std::size_t i = b * block_size; i < std::min(binned_.size(), (b + 1) * block_size); ++i)
          visit_grid(i, window_end(), [&](std::size_t j, const Image& image) {
            if (particles_->ids[i] < particles_->ids[j] && may_touch(test, i, j, image, -0.5 * step_))
              lists_[b].push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 0, 0});
          });
      },
      1);
}

} // namespace keeler
