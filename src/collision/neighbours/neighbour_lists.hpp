// Neighbour lists with a skin (Verlet 1967), kept over many steps and many hits. They yield the pairs that may touch in
// a step.
//
// When lists are rebuilt each particle gets a reference path: the straight line of its path about the middle of the
// lists' lifetime, with a skin. Two particles are on each other's list if their reference paths come within contact
// plus both skins in that time. A list is valid as long as its particles stay within their skin, hit or kicked as they
// may be. A particle that leaves its skin gets a new reference path and list. All lists are rebuilt when they expire or
// when too many particles have left.
//
// Data by lifetime:
//   lists              ReferencePaths, VerletList
//   pruning interval   PruningInterval: lines and pruned pairs for a few steps between disturbances
//   step               SearchContext, from begin() to mark_dirty()
//   run                RebuildPolicy, which decides when lists and intervals end
//
// Invariant: a pair that is on no list cannot touch in the step, nor one that is not pruned and of which neither
// particle is dirty, through any image, unless begin() returned false or reaches_far() holds.
//
// The image of a neighbour is the nearest one. A box that is too small for that is left to grid_partners.hpp.
#pragma once

#include "ablation.hpp"
#include "all_images.hpp"
#include "pruning_interval.hpp"
#include "rebuild_policy.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace keeler::collision {

/// What the lists have cost since the run began.
struct ListCounts {
  std::uint64_t rebuilds = 0; ///< of all lists
  std::uint64_t tested = 0;   ///< pairs of lines, to build lists
  std::uint64_t listed = 0;   ///< pairs, by rebuilds of all lists
  std::uint64_t renewed = 0;  ///< lists rebuilt one by one
};

class NeighbourLists {
public:
  /// `step`: length of a step, rad.
  NeighbourLists(const Frequencies& frequencies, double step) : frequencies_(frequencies), step_length_(step) {
    assert(step > 0.0);
  }

  /// Sets the part of the box that the particles are in when lists are rebuilt.
  void set_folds(const cells::Folds& folds) { references_.set_folds(folds); }

  /// Changes the length of the steps to come. All lists are rebuilt.
  void set_step(double step) {
    assert(step > 0.0);
    release();
    step_length_ = step;
  }

  /// Begins a step: rebuilds all lists or updates the previous ones, whichever costs less. `undisturbed`: the particles
  /// of the last step have moved on by one step and been wrapped, and nothing else has changed; otherwise anything may
  /// have. Returns false if the box is so small that pairs may meet through several images: then nothing else may be
  /// called in this step. Throws InvariantError if elements are not finite. Precondition: the particles stay where they
  /// are in memory until mark_dirty().
  bool begin(const Particles& particles, const ShearingBox& box, double offset, bool undisturbed);

  /// Sets whether pairs that straight lines in double precision prove apart are left out, so that the pairs visited do
  /// not depend on the lists. The default is true.
  void visit_exactly(bool exactly) { exactly_ = exactly; }

  /// Calls visit(i, j, image of j) for every pair that may touch in this step as long as no path changes. Blocks, of
  /// which there are blocks(), may be visited by several threads. Precondition: no hit in the step yet.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const;
  std::size_t blocks() const { return interval_.pair_blocks() + marked_blocks(interval_.dirty()); }

  /// Returns every particle that i may touch in the step.
  std::span<const std::uint32_t> list(std::size_t i) const { return lists_.list(i); }
  /// True if its list is long, as a large body's is.
  bool has_many(std::size_t i) const { return lists_.length(i) >= many; }

  /// Calls visit(j, image of j) for every other particle that i may touch from `start` to `end` (rad after the epoch).
  /// Precondition: begin() returned true, and not reaches_far().
  template<class Visit>
  void visit_partners(std::size_t i, double start, double end, std::vector<std::uint32_t>& buffer,
                      const Visit& visit) const;
  /// As visit_partners() to the end of the step, but tries all particles through all images: for reaches_far().
  template<class Visit> void visit_everywhere(std::size_t i, double start, const Visit& visit) const {
    visit_all_images(step(), i, start, visit);
  }

  /// Updates the line of particle i, which was hit at `time` (rad). Returns false if it may leave its skin before the
  /// step ends: then rebuild_list(i) must follow before the next search. Several threads may call it for different
  /// particles.
  bool changed(std::size_t i, double time) { return interval_.follow_hit(step(), i, time, references_.line(i)); }
  /// Gives particle i a new reference path and list.
  void rebuild_list(std::size_t i);
  /// Ends the step: `particles` were hit in it, in any order.
  void mark_dirty(std::span<const std::uint32_t> particles);

  /// True if rebuild_list() met a particle that can reach beyond the nearest image before the lists expire.
  bool reaches_far() const { return reaches_far_; }
  /// Rebuilds all lists for the rest of the step alone; paths that have ended are not on them. If nearest images do not
  /// suffice for that either, reaches_far() holds on and only visit_everywhere() may be called.
  void rebuild_for_step();

  /// Returns the position of a particle's reference path, at the middle of the lists' lifetime.
  BoxPosition position(std::size_t i) const { return references_.position(i); }
  /// Returns an upper bound on that distance between two particles on each other's list.
  BoxDistance farthest_neighbour() const { return references_.cells().farthest_neighbour(); }
  /// Returns how far the shear has then moved images beyond the outer x edge along the box (2⁻³² of it).
  std::uint32_t offset_along() const { return static_cast<std::uint32_t>(references_.cells().frame().offset_y); }

  Image nearest_image(const Body& a, const Body& b) const { return step().nearest_image(a, b); }
  Image nearest_image(std::size_t i, std::size_t j) const {
    if (interval_.nearest_is_itself(i, j))
      return {};
    return nearest_image(step().particles.bodies[i], step().particles.bodies[j]);
  }

  /// Frees what is made anew when paths have changed. Precondition: no step has begun.
  void release_interval() { interval_.release(); }
  /// Forgets all lists and frees most of their memory. Precondition: no step has begun.
  void release();
  std::size_t bytes() const;
  const ListCounts& counts() const { return counts_; }

private:
  static constexpr std::uint32_t many = 64; // entries

  const SearchContext& step() const {
    assert(step_);
    return *step_;
  }
  template<class Visit> void visit_pairs(const PaddedPairs& pairs, const Visit& visit) const;

  bool valid_for(const Particles& particles, const ShearingBox& box, double offset) const;
  bool rebuild(bool were_valid);
  bool fill_lists();
  bool begin_interval();
  bool update(std::span<const std::uint32_t> escaped);
  bool renew_path(std::size_t i, const Rotation& to_middle);
  bool sound() const;

  Frequencies frequencies_;
  double step_length_; // rad
  bool exactly_ = true;

  RebuildPolicy policy_;
  ReferencePaths references_;
  VerletList lists_;
  PruningInterval interval_;
  bool valid_ = false;   // whether the next step may use the lists
  ShearingBox last_box_; // of the last step,
  double last_offset_ = 0.0;

  std::optional<SearchContext> step_;
  bool reaches_far_ = false; // in this step
  ListCounts counts_;
};

template<class Visit> void NeighbourLists::visit_block(std::size_t block, const Visit& visit) const {
  const MarkedSet& dirty = interval_.dirty();
  if (block < interval_.pair_blocks())
    visit_pairs(interval_.pairs(block), [&](std::uint32_t i, std::uint32_t j, const Image& image) {
      if (!dirty.contains(i) && !dirty.contains(j))
        visit(i, j, image);
    });
  else
    visit_pairs(pairs_of_lists(lists_, marked_members(dirty, block - interval_.pair_blocks()), dirty), visit);
}

// Visits the pairs that may touch in the step.
template<class Visit> void NeighbourLists::visit_pairs(const PaddedPairs& pairs, const Visit& visit) const {
  constexpr std::size_t chunk = 256;
  LinePair kept[chunk];
  const double half = 0.5 * step_length_;
  const LineSpan span = interval_.span(step(), -half, half);
  const std::size_t count = pair_count(pairs);
  for (std::size_t begin = 0; begin < count; begin += chunk) {
    const std::size_t some = std::min(chunk, count - begin);
    const std::size_t keeps = without(Acceleration::rejection)
                                  ? static_cast<std::size_t>(std::copy_n(pairs.data() + begin, some, kept) - kept)
                                  : interval_.filter(span, pairs.data() + begin, some, kept);
    for (std::size_t k = 0; k < keeps; ++k) {
      const auto [i, j] = kept[k];
      const Image image = nearest_image(i, j);
      if (!exactly_ || step().may_touch(i, j, image, -half))
        visit(i, j, image);
    }
  }
}

template<class Visit>
void NeighbourLists::visit_partners(std::size_t i, double start, double end, std::vector<std::uint32_t>& buffer,
                                    const Visit& visit) const {
  const std::span<const std::uint32_t> entries = list(i);
  if (buffer.size() < entries.size())
    buffer.resize(2 * entries.size());
  const std::size_t count =
      without(Acceleration::rejection)
          ? static_cast<std::size_t>(std::copy_n(entries.data(), entries.size(), buffer.data()) - buffer.data())
          : interval_.sweep(i, interval_.span(step(), start, end), entries, buffer.data());
  for (std::size_t k = 0; k < count; ++k) {
    const Image image = nearest_image(i, buffer[k]);
    if (!exactly_ || step().may_touch(i, buffer[k], image, start))
      visit(buffer[k], image);
  }
}

} // namespace keeler::collision
