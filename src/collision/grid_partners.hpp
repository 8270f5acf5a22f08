// Who may meet whom in one step, through any image: a grid in double precision, made anew every step. For boxes of a
// few particle sizes, and to offer finders all that a grid's cells hold, as the paper's experiment does.
//
// How far a relative coordinate can change within h/2 of the epoch:
//   |Δx| <= h/2 κ (e_i + e_j),   |Δy| <= h/2 [S |ΔX| + 2 (e_i + e_j)],   |ΔX| <= |Δx| + e_i + e_j.
// A new orbit is followed back to the epoch; how far it then stands from where the particle was binned (its stray)
// widens the windows of later queries.
#pragma once

#include <keeler/cells/grid.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/finders/straight_line.hpp>

#include <vector>

namespace keeler {

class GridPartners {
public:
  GridPartners(const Frequencies& frequencies, double step) : frequencies_(frequencies), step_(step) {}

  /// A step begins. `every_candidate`: all that the cells hold is visited, whether it may touch or not.
  void begin(const Particles& particles, const ShearingBox& box, double offset, bool every_candidate);

  /// Calls visit(i, j, image of j) for every pair that may touch, ids[i] < ids[j]. Blocks may be visited by several
  /// threads.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const;
  std::size_t blocks() const { return (places_.size() + block_size - 1) / block_size; }

  /// Calls visit(j, image of j) for every image of another particle that i, which was hit, may meet after `start`.
  template<class Visit> void visit_partners(std::size_t i, double start, const Visit& visit) const {
    visit_near(i, start, visit);
  }

  /// Particle i has been hit. Throws InvariantError when it, as begin() of any, may go too far in a step (reach.hpp).
  void changed(std::size_t i);

private:
  static constexpr std::size_t block_size = 512; // particles

  template<class Visit> void visit_near(std::size_t i, double start, const Visit& visit) const;
  void require_few_images() const;

  Frequencies frequencies_;
  double step_;
  bool every_candidate_ = false;
  const Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;
  PeriodicGrid grid_;
  std::vector<Vec3> places_; // as the grid knows them
  double largest_radius_ = 0.0, largest_eccentricity_ = 0.0, largest_stray_ = 0.0;
  StraightLineTest test_;
};

template<class Visit> void GridPartners::visit_near(std::size_t i, double start, const Visit& visit) const {
  constexpr double wider = 1.0 + 1e-9;
  const Body& body = particles_->bodies[i];
  const double e = body.elements.eccentricity() + largest_eccentricity_, half = 0.5 * step_;
  const double x = body.radius + largest_radius_ + half * frequencies_.kappa * e;
  const double y = body.radius + largest_radius_ + half * (frequencies_.shear() * (x + e) + 2.0 * e);
  const double stray = largest_stray_ + 1e-12 * (box_.size_x + box_.size_y);
  const auto other = [&](std::size_t j, const Image& image) {
    if (j == i)
      return;
    const Vec3 shift = box_.displacement(image, offset_);
    if (every_candidate_ || test_.may_touch(body, particles_->bodies[j], shift.x(), shift.y(), start))
      visit(j, image);
  };
  const Vec3 place = state_at(body.elements, frequencies_, Rotation()).position;
  if (every_candidate_)
    grid_.visit_touched_cells(place, wider * x + stray, wider * y + stray, other);
  else
    grid_.visit_near(place, wider * x + stray, wider * y + stray, other);
}

template<class Visit> void GridPartners::visit_block(std::size_t block, const Visit& visit) const {
  const std::size_t begin = block * block_size, end = std::min(places_.size(), begin + block_size);
  for (std::size_t i = begin; i < end && !interrupted(); ++i)
    visit_near(i, -0.5 * step_, [&](std::size_t j, const Image& image) {
      if (particles_->ids[i] < particles_->ids[j])
        visit(i, j, image);
    });
}

} // namespace keeler
