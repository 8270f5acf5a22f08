// The pruning interval of the dual list (Páll et al. 2020): some steps in which only hits disturb the paths, from one
// kick to the next for instance. When it begins all particles get their present line, and the pairs that may touch in
// it, the pruned pairs, are picked from the lists. A particle that is hit gets a new line and is dirty from then on:
// its whole list replaces its pruned pairs.
//
// Invariant: a pair that is not pruned, and of which neither particle is dirty, cannot touch in the interval.
#pragma once

#include "listed_pairs.hpp"
#include "reference_paths.hpp"

#include <cassert>
#include <span>
#include <vector>

namespace keeler::collision {

class PruningInterval {
public:
  /// Begins an interval of `length` steps with new lines. Returns the particles that may leave their skin in it.
  std::vector<std::uint32_t> begin(const SearchContext& step, int length, const ReferencePaths& references);
  /// Picks the pruned pairs from the lists; no particle is dirty or escaped afterwards. Returns the number of pairs
  /// tested. `step`: length of a step, rad.
  std::uint64_t prune(const VerletList& list, double step);

  /// Begins the next step; look_ahead() must follow if the interval continues.
  void begin_step() { ++steps_.age; }
  /// Finds the rotation from this epoch to the middle of the interval.
  void look_ahead(const SearchContext& step);

  const StepInterval& steps() const { return steps_; }

  /// Gives particle i, which was hit at `time` (rad), a new line. Returns false if it may leave its skin before the
  /// step ends. Several threads may call it for different particles.
  bool follow_hit(const SearchContext& step, std::size_t i, double time, const Line& reference);

  /// Notes that the list of particle i has been rebuilt.
  void renewed(std::size_t i) { dirty_.insert(i); }
  /// Notes that particle i stays within its new skin.
  void stays(std::size_t i) { escapes_later_[i] = 0; }
  /// Notes that particle i was hit in the step that ends.
  void mark_dirty(std::size_t i) {
    dirty_.insert(i);
    if (escapes_later_[i])
      escaped_.push_back(static_cast<std::uint32_t>(i));
    escapes_later_[i] = 0;
  }
  const MarkedSet& dirty() const { return dirty_; }
  /// Particles that may leave their skin in the interval after the step that has ended.
  std::span<const std::uint32_t> escaped() const { return escaped_; }
  void clear_escaped() { escaped_.clear(); }
  void resize(std::size_t particles) { dirty_.resize(particles); } ///< for lists renewed before the first interval

  std::size_t pair_blocks() const { return pruned_.size(); }
  const PaddedPairs& pairs(std::size_t block) const { return pruned_[block]; }

  /// Returns the span from `start` to `end` (rad after the epoch) in the time of the lines.
  LineSpan span(const SearchContext& step, double start, double end) const {
    const double epoch = steps_.since_middle(step.step);
    return widened(epoch + start, epoch + end, steps_.half(step.step));
  }

  /// Apply LineSweep and LinePairFilter to the lines.
  std::size_t sweep(std::size_t i, const LineSpan& span, std::span<const std::uint32_t> indices,
                    std::uint32_t* kept) const {
    assert(i < lines_.size());
    return kernels_.sweep(lines_[i], lines_.data(), frame_, span, indices.data(), indices.size(), kept);
  }
  std::size_t filter(const LineSpan& span, const LinePair* pairs, std::size_t count, LinePair* kept) const {
    assert(!lines_.empty());
    return kernels_.filter(lines_.data(), frame_, span, pairs, count, kept);
  }

  /// True only if the nearest image of j to i is j itself in the whole step. Decided by the lines alone: the particles
  /// have not been wrapped since these were made, and are less than a quarter of the box apart.
  bool nearest_is_itself(std::size_t i, std::size_t j) const {
    const Line &a = lines_[i], &b = lines_[j];
    const auto near = [](std::int32_t from, std::int32_t to) {
      return std::abs(static_cast<std::int64_t>(to) - from) < std::int64_t{1} << 30;
    };
    return steps_.age == 0 && (a.tag | b.tag) == 0 && near(a.x, b.x) && near(a.y, b.y);
  }

  std::vector<Line>& buffer() { return lines_; } ///< memory to be reused before begin()
  /// Frees the lines and the pairs: the interval is over. Precondition: begin() follows before the next sweep() or
  /// filter().
  void release();
  bool over() const { return steps_.over() || lines_.empty(); }
  std::size_t bytes() const;
  /// True if the bookkeeping is consistent, for so many particles.
  bool sound(std::size_t particles) const;

private:
  std::uint64_t prune_lists(const VerletList& list, std::size_t first, std::size_t last, double step,
                            std::vector<LinePair>& kept) const;

  Kernels kernels_ = kernels(choose_instruction_set());
  StepInterval steps_;
  Rotation to_middle_; // of the interval, from this epoch
  Instant middle_;     // that time and its shear offset
  LineFrame frame_{};  // of then
  FollowFrame follow_{};
  std::vector<Line> lines_; // tangent in the middle, by particle
  std::vector<PaddedPairs> pruned_;
  MarkedSet dirty_; // particles that were hit or got a new list in the interval
  std::vector<std::uint32_t> escaped_;
  std::vector<std::uint8_t> escapes_later_; // by particle: hit in this step, may leave its skin in a later one
};

} // namespace keeler::collision
