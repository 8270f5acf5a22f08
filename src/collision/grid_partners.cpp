#include "grid_partners.hpp"

#include "reach.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::collision {

void GridPartners::begin(const Particles& particles, const ShearingBox& box, double offset, bool every_candidate) {
  assert(box.size_x > 0.0 && box.size_y > 0.0);
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  every_candidate_ = every_candidate;
  const std::size_t count = particles.size();
  positions_.resize(count);
  static const Rotation at_epoch;
  parallel_for(count, [&](std::size_t k) {
    positions_[k] = state_at(particles.bodies[k].elements, frequencies_, at_epoch).position;
  });
  max_radius_ = max_eccentricity_ = max_stray_ = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const Body& body = particles.bodies[k];
    const double e = body.elements.eccentricity();
    if (!(std::isfinite(e) && std::isfinite(body.elements.i_cos) && positions_[k].allFinite()))
      throw InvariantError(fmt::format("particle {} has elements that are not finite", particles.ids[k]));
    max_radius_ = std::max(max_radius_, body.radius);
    max_eccentricity_ = std::max(max_eccentricity_, e);
  }
  require_few_images();
  grid_.build(positions_, box, offset, 2.0 * max_radius_ + step_ * max_eccentricity_);
  test_ = {frequencies_, 0.5 * step_, 0.5 * step_, 1e-13 * (box.size_x + box.size_y)};
}

void GridPartners::require_few_images() const {
  const double x = 2.0 * max_radius_ + step_ * frequencies_.kappa * max_eccentricity_;
  const double y = 2.0 * max_radius_ + 0.5 * step_ * (frequencies_.shear() * x + 6.0 * max_eccentricity_);
  require_reach(x, y, box_);
}

void GridPartners::changed(std::size_t i) {
  assert(particles_ && i < positions_.size());
  const Elements& el = particles_->bodies[i].elements;
  const Vec3 position = state_at(el, frequencies_, Rotation()).position;
  max_eccentricity_ = std::max(max_eccentricity_, el.eccentricity());
  max_stray_ = std::max(max_stray_, (position - positions_[i]).cwiseAbs().maxCoeff());
  require_few_images();
}

} // namespace keeler::collision
