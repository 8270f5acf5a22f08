// The pruning interval of the dual list (Páll et al. 2020): some steps in which nothing but hits disturbs the paths,
// from one kick to the next for instance. When it begins all particles get their present line, and the pairs that may
// touch in it are pruned out of the lists. A particle that is hit gets a new line and is dirty from then on: its whole
// list stands in for its pruned pairs.
//
// Invariant: a pair that is not pruned, and of which neither particle is dirty, cannot touch in the interval.
#pragma once

#include "listed_pairs.hpp"
#include "reference_paths.hpp"

#include <span>
#include <vector>

namespace keeler {

class PruningInterval {
public:
  /// Begins an interval of `length` steps with new lines. Returns the particles that may leave their skin in it.
  std::vector<std::uint32_t> begin(const SearchContext& step, int length, const ReferencePaths& references);
  /// Prunes the lists for the interval, and clears dirty and escaped particles. Returns the number of pairs tested.
  std::uint64_t prune(const ListedPairs& pairs, const VerletList& list, double step);

  /// The next step begins; look_ahead() follows if the interval goes on.
  void begin_step() { ++steps_.age; }
  void look_ahead(const SearchContext& step);

  const StepInterval& steps() const { return steps_; }

  /// Particle i has been hit at `time` (rad): gives it a new line. Returns false if it may leave its skin before the
  /// step ends. Several threads may call it for different particles.
  bool follow_hit(const SearchContext& step, std::size_t i, double time, const Line& reference);

  /// The list of particle i has been rebuilt.
  void renewed(std::size_t i) { dirty_.insert(i); }
  void stays(std::size_t i) { escapes_later_[i] = 0; }
  /// Particle i was hit in the step that ends.
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

  /// The time from `start` to `end` (rad after the epoch) as that of the lines.
  LineSpan span(const SearchContext& step, double start, double end) const {
    const double epoch = steps_.since_middle(step.step);
    return widened(epoch + start, epoch + end, steps_.half(step.step));
  }

  /// LineSweep and LinePairFilter by these lines.
  std::size_t sweep(std::size_t i, const LineSpan& span, std::span<const std::uint32_t> indices,
                    std::uint32_t* kept) const {
    return kernels_.sweep(lines_[i], lines_.data(), frame_, span, indices.data(), indices.size(), kept);
  }
  std::size_t filter(const LineSpan& span, const LinePair* pairs, std::size_t count, LinePair* kept) const {
    return kernels_.filter(lines_.data(), frame_, span, pairs, count, kept);
  }

  /// True if the lines alone tell that the nearest image of j to i is j itself: while particles have not been wrapped
  /// since the lines were made, and both are far from half a box apart, whatever a step brings.
  bool nearest_is_itself(std::size_t i, std::size_t j) const {
    const Line &a = lines_[i], &b = lines_[j];
    const auto near = [](std::int32_t from, std::int32_t to) {
      return std::abs(static_cast<std::int64_t>(to) - from) < std::int64_t{1} << 30;
    };
    return steps_.age == 0 && (a.tag | b.tag) == 0 && near(a.x, b.x) && near(a.y, b.y);
  }

  const Line* lines() const { return lines_.data(); } ///< by particle
  std::vector<Line>& buffer() { return lines_; }      ///< before begin(): memory for as many lines
  void prefetch(std::size_t i) const { __builtin_prefetch(&lines_[i], 1); }
  void release();
  std::size_t bytes() const;
  bool sound(std::size_t particles) const;

private:
  Kernels kernels_ = kernels(choose_instruction_set());
  StepInterval steps_;
  Rotation to_middle_; // of the interval, from this epoch
  Instant middle_;     // the same time, and the shear offset then
  LineFrame frame_{};  // of then
  FollowFrame follow_{};
  std::vector<Line> lines_; // tangent in the middle, by particle
  std::vector<PaddedPairs> pruned_;
  MarkedSet dirty_; // hit, or their list rebuilt, in the interval
  std::vector<std::uint32_t> escaped_;
  std::vector<std::uint8_t> escapes_later_; // of each particle hit in the step: in a later step of the interval
};

} // namespace keeler
