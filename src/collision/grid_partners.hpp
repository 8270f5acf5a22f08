// Broad phase for small boxes: a cell grid in double precision, rebuilt every step, yields candidate pairs through all
// periodic images. It also offers finders all that a grid's cells hold, as the experiment of the paper does.
//
// Bounds on the change of a relative coordinate within h/2 of the epoch:
//   |Δx| <= h/2 κ (e_i + e_j),   |Δy| <= h/2 [S |ΔX| + 2 (e_i + e_j)],   |ΔX| <= |Δx| + e_i + e_j.
// A new orbit is traced back to the epoch; its distance there from where the particle was binned (its stray) widens the
// windows of later queries.
#pragma once

#include <keeler/cells/grid.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/finders/straight_line.hpp>

#include <algorithm>
#include <cassert>
#include <vector>

namespace keeler::collision {

class GridPartners {
public:
  /// `step`: length of a step, rad.
  GridPartners(const Frequencies& frequencies, double step) : frequencies_(frequencies), step_(step) {
    assert(step > 0.0);
  }

  /// Begins a step: bins the particles. `every_candidate`: visits all pairs that the cells hold, even if they cannot
  /// touch. Throws InvariantError if elements are not finite, or as require_reach(). Precondition: the particles stay
  /// where they are in memory until the step ends.
  void begin(const Particles& particles, const ShearingBox& box, double offset, bool every_candidate);

  /// Calls visit(i, j, image of j) for every pair that may touch, ids[i] < ids[j]. Blocks, of which there are blocks(),
  /// may be visited by several threads.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const;
  std::size_t blocks() const { return (positions_.size() + block_size - 1) / block_size; }

  /// Calls visit(j, image of j) for every image of another particle that i may touch from `start` (rad) on.
  template<class Visit> void visit_partners(std::size_t i, double start, const Visit& visit) const {
    visit_near(i, start, visit);
  }

  /// Accounts for the new orbit of particle i. Throws InvariantError as require_reach().
  void changed(std::size_t i);

private:
  static constexpr std::size_t block_size = 512; // particles

  template<class Visit> void visit_near(std::size_t i, double start, const Visit& visit) const;
  void require_few_images() const;

  Frequencies frequencies_;
  double step_;
  bool every_candidate_ = false;
  const Particles* particles_ = nullptr; // of the present step
  ShearingBox box_;
  double offset_ = 0.0;
  cells::PeriodicGrid grid_;
  std::vector<Vec3> positions_;                                        // that the grid has binned
  double max_radius_ = 0.0, max_eccentricity_ = 0.0, max_stray_ = 0.0; // m
  finders::StraightLineTest test_;
};

template<class Visit> void GridPartners::visit_near(std::size_t i, double start, const Visit& visit) const {
  assert(particles_ && i < positions_.size());
  constexpr double wider = 1.0 + 1e-9;
  const Body& body = particles_->bodies[i];
  const double e = body.elements.eccentricity() + max_eccentricity_, half = 0.5 * step_;
  const double x = body.radius + max_radius_ + half * frequencies_.kappa * e;
  const double y = body.radius + max_radius_ + half * (frequencies_.shear() * (x + e) + 2.0 * e);
  const double stray = max_stray_ + 1e-12 * (box_.size_x + box_.size_y);
  const auto other = [&](std::size_t j, const Image& image) {
    if (j == i)
      return;
    const Vec3 shift = box_.displacement(image, offset_);
    if (every_candidate_ || test_.may_touch(body, particles_->bodies[j], shift.x(), shift.y(), start))
      visit(j, image);
  };
  const Vec3 position = state_at(body.elements, frequencies_, Rotation()).position;
  if (every_candidate_)
    grid_.visit_touched_cells(position, wider * x + stray, wider * y + stray, other);
  else
    grid_.visit_near(position, wider * x + stray, wider * y + stray, other);
}

template<class Visit> void GridPartners::visit_block(std::size_t block, const Visit& visit) const {
  assert(block < blocks());
  const std::size_t begin = block * block_size, end = std::min(positions_.size(), begin + block_size);
  for (std::size_t i = begin; i < end && !interrupted(); ++i)
    visit_near(i, -0.5 * step_, [&](std::size_t j, const Image& image) {
      if (particles_->ids[i] < particles_->ids[j])
        visit(i, j, image);
    });
}

} // namespace keeler::collision
