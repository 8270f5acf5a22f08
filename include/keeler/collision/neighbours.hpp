// Who may meet whom: candidate pairs from bounds, never from statistics, kept for a window of steps.
//
// At the first step of a window all places go into a grid, and every pair whose straight lines about that epoch may
// come into contact before the window ends, with all that curvature, kicks (the skin) and rounding can add, goes into a
// list. Later steps of the window only go through the list. A particle that was hit has a new orbit: its entries die,
// and new ones are made from what its orbit can reach in the rest of the window. So at every step each pair that could
// touch is visited exactly once, and no result depends on the length of windows.
//
// How far a relative coordinate can change in a time T from the epoch of the grid:
//   |Δx| <= T κ (e_i + e_j),   |Δy| <= T [S |ΔX| + 2 (e_i + e_j)],   |ΔX| <= |Δx| + e_i + e_j.
// A new orbit is followed back to that epoch; how far it then stands from where the particle was binned (its stray)
// widens the windows of later queries, as does what kicks have added.
//
// In a window of several steps the image of a partner is the nearest one; a box that is too small for that, or a step
// that is too long, has windows of one step, and images come from the grid.
#pragma once

#include <keeler/cells/grid.hpp>
#include <keeler/collision/straight_line.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

class Neighbours {
public:
  Neighbours(const Frequencies& frequencies, double step) : frequencies_(frequencies), step_(step) {}

  /// A step begins. Opens a new window unless the last one can go on: see moved_on(). Throws InvariantError when
  /// elements are not finite.
  void begin(const Particles& particles, const ShearingBox& box, double offset);

  /// The particles of the last step have moved on by exactly one step and been wrapped; nothing else happened to them.
  void moved_on() { goes_on_ = true; }

  /// Every particle has been kicked by at most this much (m rad⁻¹).
  void kicked(double largest);

  /// Particle i has been hit and has a new orbit.
  void changed(std::size_t i);

  /// Visits every pair that may touch in this step as long as nothing changes: visit(i, j, image of j), ids[i] <
  /// ids[j]. Blocks, of which there are blocks(), may be visited by several threads.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const;
  std::size_t blocks() const { return listed_ ? lists_.size() + 1 : (binned_.size() + block_size - 1) / block_size; }

  /// Visits every partner that particle i, which was hit, may meet in the rest of the step from `start` on: visit(j,
  /// image). Notes those of the rest of the window. Leaves out `except`.
  template<class Visit> void visit_partners(std::size_t i, std::size_t except, double start, const Visit& visit);

  /// All that the grid's cells hold is visited, whether it may touch or not: to measure finders.
  bool every_candidate = false;

private:
  static constexpr std::size_t block_size = 512; // of particles

  /// Places, the lower id first. Alive as long as neither has changed since.
  struct Entry {
    std::uint32_t low, high;
    std::uint32_t low_changes, high_changes;
  };

  void open();
  int length_for(double mean_eccentricity, double mean_radius) const;
  void list_pairs();
  bool alive(const Entry& e) const { return changes_[e.low] == e.low_changes && changes_[e.high] == e.high_changes; }
  double since_open() const { return at_step_ * step_; } // from the epoch of the grid to this step's
  double window_end() const { return (length_ - 0.5) * step_; }
  double reach_x(double eccentricity, double contact, double time) const;
  double reach_y(double eccentricity, double contact, double time) const;
  Image nearest_image(std::size_t i, std::size_t j) const;
  bool may_touch(const StraightLineTest& test, std::size_t i, std::size_t j, const Image& image, double start) const;
  template<class Visit> void visit_grid(std::size_t i, double time, const Visit& visit) const;

  Frequencies frequencies_;
  double step_;
  const Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;

  // the window
  bool goes_on_ = false, listed_ = false;
  int at_step_ = 0, length_ = 0;
  PeriodicGrid grid_;
  std::vector<Vec3> binned_;           // places as the grid knows them
  std::vector<std::uint32_t> changes_; // of each particle's orbit
  std::vector<std::vector<Entry>> lists_;
  std::vector<Entry> added_; // after collisions
  double largest_radius_ = 0.0, largest_eccentricity_ = 0.0, largest_stray_ = 0.0;
  double plain_eccentricity_ = 0.0;     // up to this one the nearest image is the only one in reach
  double kick_path_ = 0.0, skin_ = 0.0; // how far kicks may have moved a particle; how far the lists allow
  double last_kick_ = 0.0;
  std::uint64_t hits_ = 0;
  StraightLineTest step_test_, window_test_;
};

template<class Visit> void Neighbours::visit_grid(std::size_t i, double time, const Visit& visit) const {
  constexpr double wider = 1.0 + 1e-9;
  const Body& body = particles_->bodies[i];
  const double e = body.elements.eccentricity() + largest_eccentricity_;
  const double contact = body.radius + largest_radius_;
  const double stray = largest_stray_ + 2.0 * kick_path_ + 1e-12 * (box_.size_x + box_.size_y);
  const double x = wider * reach_x(e, contact, time) + stray, y = wider * reach_y(e, contact, time) + stray;
  const auto other = [&](std::size_t j, const Image& image) {
    if (j != i)
      visit(j, image);
  };
  const Vec3 place = at_step_ == 0
                         ? state_at(body.elements, frequencies_, Rotation()).position
                         : state_at(body.elements, frequencies_, Rotation(frequencies_, -since_open())).position;
  if (every_candidate)
    grid_.visit_touched_cells(place, x, y, other);
  else
    grid_.visit_near(place, x, y, other);
}

template<class Visit> void Neighbours::visit_block(std::size_t block, const Visit& visit) const {
  const double start = -0.5 * step_;
  if (listed_) {
    for (const Entry& e : block < lists_.size() ? lists_[block] : added_) {
      const Image image = nearest_image(e.low, e.high);
      if (may_touch(step_test_, e.low, e.high, image, start) && alive(e))
        visit(e.low, e.high, image);
    }
    return;
  }
  for (std::size_t i = block * block_size; i < std::min(binned_.size(), (block + 1) * block_size); ++i)
    visit_grid(i, 0.5 * step_, [&](std::size_t j, const Image& image) {
      if (particles_->ids[i] < particles_->ids[j] && (every_candidate || may_touch(step_test_, i, j, image, start)))
        visit(i, j, image);
    });
}

template<class Visit>
void Neighbours::visit_partners(std::size_t i, std::size_t except, double start, const Visit& visit) {
  if (particles_->bodies[i].elements.eccentricity() > plain_eccentricity_)
    length_ = at_step_ + 1; // it may reach farther than the lists can tell images apart: a new window next step
  const bool more_steps = at_step_ + 1 < length_;
  const double time = more_steps ? window_end() : since_open() + 0.5 * step_;
  visit_grid(i, time, [&](std::size_t j, const Image& image_then) {
    if (j == except)
      return;
    const Image image = listed_ && at_step_ > 0 ? nearest_image(i, j) : image_then;
    if (every_candidate || may_touch(step_test_, i, j, image, start))
      visit(j, image);
    if (more_steps && may_touch(window_test_, i, j, image, start)) {
      const bool ordered = particles_->ids[i] < particles_->ids[j];
      const auto low = static_cast<std::uint32_t>(ordered ? i : j), high = static_cast<std::uint32_t>(ordered ? j : i);
      added_.push_back({low, high, changes_[low], changes_[high]});
    }
  });
}

} // namespace keeler
