#include "grid_partners.hpp"

#include "reach.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

namespace keeler {

void GridPartners::begin(const Particles& particles, const ShearingBox& box, double offset, bool every_candidate) {
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  every_candidate_ = every_candidate;
  const std::size_t count = particles.size();
  places_.resize(count);
  static const Rotation at_epoch;
  parallel_for(count, [&](std::size_t k) {
    places_[k] = state_at(particles.bodies[k].elements, frequencies_, at_epoch).position;
  });
  largest_radius_ = largest_eccentricity_ = largest_stray_ = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const Body& body = particles.bodies[k];
    const double e = body.elements.eccentricity();
    if (!(std::isfinite(e) && std::isfinite(body.elements.i_cos) && places_[k].allFinite()))
      throw InvariantError(fmt::format("particle {} has elements that are not finite", particles.ids[k]));
    largest_radius_ = std::max(largest_radius_, body.radius);
    largest_eccentricity_ = std::max(largest_eccentricity_, e);
  }
  require_few_images();
  grid_.build(places_, box, offset, 2.0 * largest_radius_ + step_ * largest_eccentricity_);
  test_ = {frequencies_, 0.5 * step_, 0.5 * step_, 1e-13 * (box.size_x + box.size_y)};
}

void GridPartners::require_few_images() const {
  const double x = 2.0 * largest_radius_ + step_ * frequencies_.kappa * largest_eccentricity_;
  const double y = 2.0 * largest_radius_ + 0.5 * step_ * (frequencies_.shear() * x + 6.0 * largest_eccentricity_);
  require_reach(x, y, box_);
}

void GridPartners::changed(std::size_t i) {
  const Elements& el = particles_->bodies[i].elements;
  const Vec3 place = state_at(el, frequencies_, Rotation()).position;
  largest_eccentricity_ = std::max(largest_eccentricity_, el.eccentricity());
  largest_stray_ = std::max(largest_stray_, (place - places_[i]).cwiseAbs().maxCoeff());
  require_few_images();
}

} // namespace keeler
