// The broad phase of a drift step (Hubbard 1995): a superset of the pairs that may touch, from neighbour lists that
// last many steps; or from a grid of the step where the box is too small for nearest images, or all candidates are
// wanted.
#pragma once

#include "grid_partners.hpp"
#include "neighbours/neighbour_lists.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::collision {

class BroadPhase {
public:
  BroadPhase(const Frequencies& frequencies, double step)
      : frequencies_(frequencies), lists_(frequencies, step), grid_(frequencies, step) {}

  /// Sets the length of the following steps (rad).
  void set_step(double step) {
    lists_.set_step(step);
    grid_ = GridPartners(frequencies_, step);
  }

  /// Begins a step. `every_candidate`: all that the grid's cells hold, whether it may touch or not. `exactly`: what is
  /// visited does not depend on the history of the lists. `undisturbed`: see DriftPhase::collide().
  void begin(const Particles& particles, const ShearingBox& box, double offset, bool undisturbed, bool every_candidate,
             bool exactly) {
    if (every_candidate)
      lists_.release();
    through_grid_ = every_candidate || !lists_.begin(particles, box, offset, undisturbed);
    lists_.visit_exactly(exactly);
    if (through_grid_)
      grid_.begin(particles, box, offset, every_candidate);
  }
  /// Ends a step. `dirty`: all particles that were hit, in any order.
  void end(std::span<const std::uint32_t> dirty) {
    if (!through_grid_)
      lists_.mark_dirty(dirty);
  }

  /// True if the step uses the grid; then lists() may not be asked.
  bool through_grid() const { return through_grid_; }
  /// True if all particles are tried, in all images: no list or cell has a say.
  bool tries_all() const { return !through_grid_ && lists_.reaches_far(); }

  /// Calls visit(i, j, image of j) for each pair of a block that may touch while nothing changes. Blocks may be visited
  /// by several threads.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const {
    if (through_grid_)
      grid_.visit_block(block, visit);
    else
      lists_.visit_block(block, visit);
  }
  std::size_t blocks() const { return through_grid_ ? grid_.blocks() : lists_.blocks(); }

  /// Calls visit(j, image of j) for each other particle that i may touch between these times.
  template<class Visit>
  void visit_partners(std::uint32_t i, double from, double until, std::vector<std::uint32_t>& buffer,
                      const Visit& visit) const {
    if (through_grid_)
      grid_.visit_partners(i, from, visit);
    else if (lists_.reaches_far())
      lists_.visit_everywhere(i, from, visit);
    else
      lists_.visit_partners(i, from, until, buffer, visit);
  }

  /// Takes note that particle i has a new orbit from `time` on.
  void changed(std::uint32_t i, double time) {
    if (through_grid_)
      grid_.changed(i);
    else if (!lists_.reaches_far() && !lists_.changed(i, time))
      rebuild_list(i);
  }

  bool has_many(std::uint32_t i) const { return !through_grid_ && lists_.has_many(i); }

  NeighbourLists& lists() { return lists_; }
  const NeighbourLists& lists() const { return lists_; }

private:
  void rebuild_list(std::uint32_t i) {
    lists_.rebuild_list(i);
    if (lists_.reaches_far())
      lists_.rebuild_for_step();
  }

  Frequencies frequencies_;
  NeighbourLists lists_;
  GridPartners grid_;
  bool through_grid_ = false;
};

} // namespace keeler::collision
