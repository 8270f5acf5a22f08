// Neighbour lists with a skin (Verlet 1967), kept over many steps and many hits.
//
// When lists are made each particle gets a reference: the straight line of its path about the middle of the lists'
// life, with a slack about it. Two particles are on each other's list when their references come within contact and
// both slacks in that time. A list serves as long as its owner and those on it stay within their slack, hit or kicked
// as they may be. Who leaves gets a new reference, and its entries are found anew; all are when the life is over or
// when too many leave.
//
// Within that life a window is a few steps in which nothing but hits disturbs the paths: from one kick to the next,
// say. When it begins all particles get their present line for it, which tells who leaves its slack in the window, and
// the pairs that may touch in it, the near ones, are picked out of the lists. Who is hit gets a new line; then its list
// stands for its near pairs.
//
// Invariants: entries are mutual, j on i's list and i on j's; a pair that is on no list cannot touch in the step, nor
// one that is not near and of which neither was touched in the window, through any image, unless begin() returned false
// or reaches_far() holds.
//
// The image of a neighbour is the nearest one. A box that is too small for that is a matter for grid_partners.hpp.
#pragma once

#include "ablation.hpp"
#include "line_cells.hpp"
#include "reach.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/finders/straight_line.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace keeler {

class NeighbourLists {
public:
  NeighbourLists(const Frequencies& frequencies, double step) : frequencies_(frequencies), step_(step) {}

  /// The length of the steps to come. All lists are made anew.
  void set_step(double step) {
    release();
    step_ = step;
  }

  /// A step begins. Makes all lists anew or mends those of before, as it costs less. `undisturbed`: the particles of
  /// the last step have moved on by one step and been wrapped, nothing else; otherwise nothing need be as it was.
  /// Returns false when the box is so small that pairs may meet through several images: then nothing else may be asked.
  /// Throws InvariantError when elements are not finite.
  bool begin(const Particles& particles, const ShearingBox& box, double offset, bool undisturbed);

  /// Whether to leave out all that a straight line in double precision can prove apart, so that what is visited is the
  /// same whatever the lists, and not merely enough.
  void visit_exactly(bool exactly) { exactly_ = exactly; }

  /// Calls visit(i, j, image of j) for every pair that may touch in this step as long as nothing changes, by their
  /// straight lines. Blocks, of which there are blocks(), may be visited by several threads.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const;
  std::size_t blocks() const { return near_.size() + touched_blocks(); }

  /// Everybody whom particle i may touch in the step.
  std::span<const std::uint32_t> list(std::size_t i) const {
    return {entries_.data() + ranges_[i].begin, ranges_[i].count};
  }

  /// Calls visit(j, image of j) for every other particle that i may touch from `start` to `end`.
  template<class Visit>
  void visit_partners(std::size_t i, double start, double end, std::vector<std::uint32_t>& buffer,
                      const Visit& visit) const;
  /// Whether its list is long, as a large body's is.
  bool has_many(std::size_t i) const { return ranges_[i].count >= many; }
  /// The same through all images, tried with everybody: when reaches_far().
  template<class Visit> void visit_everywhere(std::size_t i, double start, const Visit& visit) const;

  /// Particle i has been hit, at that time. Returns false when it may leave its slack before the step ends: then
  /// list_anew(i) must follow before anybody asks for partners.
  bool changed(std::size_t i, double time);
  void list_anew(std::size_t i);
  /// To be told, in any order, when the step is over: who has been hit.
  void touched(std::span<const std::uint32_t> particles);

  /// Whether list_anew() has met somebody so fast that nearest images will not do for the rest of the lists' life.
  bool reaches_far() const { return reaches_far_; }
  /// Then: makes all lists anew for the rest of the step alone. They know nothing of paths that have ended. Where
  /// nearest images will not do for that either, reaches_far() holds on, and only visit_everywhere() may be asked.
  void make_for_step();

  /// Where the reference of a particle stands across the box, as a fraction of it (2⁻³²).
  std::uint32_t across(std::size_t i) const {
    return static_cast<std::uint32_t>(references_[i].x) + (std::uint32_t{1} << 31);
  }

  /// No two on each other's list are farther apart there.
  std::uint64_t farthest_across() const { return cells_.farthest_across(); }

  Image nearest_image(const Body& a, const Body& b) const;
  /// The same of two particles, by their lines alone where particles have not been wrapped since these were made.
  Image nearest_image(std::size_t i, std::size_t j) const {
    const Line &a = lines_[i], &b = lines_[j];
    const auto near = [](std::int32_t from, std::int32_t to) { // in the box, not round it, whatever the step brings
      return std::abs(static_cast<std::int64_t>(to) - from) < std::int64_t{1} << 30;
    };
    if (window_age_ == 0 && (a.place | b.place) == 0 && near(a.x, b.x) && near(a.y, b.y))
      return {};
    return nearest_image(particles_->bodies[i], particles_->bodies[j]);
  }

  /// Three calls for a particle, some time apart, bring what a hit needs into the cache.
  void prefetch(std::size_t i, int stage) const;

  /// Forgets all lists and gives most of their memory back.
  void release();
  std::size_t bytes() const;

  std::uint64_t built = 0, tested = 0, listed = 0, listed_anew = 0; ///< so far

private:
  static constexpr std::size_t block_size = 1024; // particles
  static constexpr std::uint32_t many = 64;       // entries
  static constexpr std::size_t few = 64;          // particles of which the whole lists are gone through

  /// Where a particle's entries are.
  struct Range {
    std::uint32_t begin = 0, count = 0, room = 0;
  };
  /// So long after this epoch, and the shear offset of then.
  struct Instant {
    double after = 0.0, offset = 0.0;
  };
  struct Parts;
  using Pairs = std::vector<LinePair>; // with padding behind

  std::size_t touched_blocks() const { return (touched_.size() + few - 1) / few; }
  template<class Visit>
  void visit_lists(std::span<const std::uint32_t> of, const std::vector<std::uint8_t>& marked,
                   const Visit& visit) const;
  template<class Visit> void visit_pairs(std::span<const LinePair> pairs, const Visit& visit) const;
  bool may_touch(std::size_t i, std::size_t j, const Image& image, double start) const {
    const Vec3 shift = box_.displacement(image, offset_);
    return test_.may_touch(particles_->bodies[i], particles_->bodies[j], shift.x(), shift.y(), start);
  }

  bool serves(const Particles& particles, const ShearingBox& box, double offset) const;
  void choose_life(bool lived);
  bool build(bool lived);
  bool make_cells(int life);
  bool fill_lists();
  void make_references();
  void find_pairs();
  void lay_out(const Parts& parts);
  void fill(const Parts& parts);
  bool begin_window();
  void set_window(int length);
  void look_to_window();
  void follow(std::vector<std::uint32_t>& leavers);
  void pick_near();
  bool mend(const std::vector<std::uint32_t>& leavers);
  bool refer_anew(std::size_t i, const Rotation& to_middle);
  Rotation to_middle_of_rest() const { return {frequencies_, 0.5 * (life_ - age_ - 1) * step_}; }
  void replace_list(std::uint32_t i, std::span<const std::uint32_t> found);
  void erase(std::uint32_t of, std::uint32_t entry);
  void append(std::uint32_t to, std::uint32_t entry);
  void grow(Range& range, std::uint32_t room);
  void mark(std::vector<std::uint32_t>& which, std::vector<std::uint8_t>& marks, std::size_t i);
  Instant instant(double after) const;
  Line line_of(const Body& body, const Rotation& tangent, double margin, double half, const Instant& at) const;
  float rounding_of(const Line& line, double half) const;
  void assert_sound() const; // there with assertions only

  /// From the middle of the lists' life, and of the window, to this epoch.
  double since_middle() const { return (age_ + 0.5 - 0.5 * life_) * step_; }
  double since_window() const { return (window_age_ + 0.5 - 0.5 * window_) * step_; }
  double half_life() const { return 0.5 * life_ * step_; }
  double half_window() const { return 0.5 * window_ * step_; }
  /// Wider by what single precision does to times.
  static LineSpan wider(double begin, double end, double half) {
    return {static_cast<float>(begin - 1e-6 * half), static_cast<float>(end + 1e-6 * half)};
  }
  LineSpan in_step(double start, double end) const {
    return wider(since_window() + start, since_window() + end, half_window());
  }

  Frequencies frequencies_;
  double step_;
  Kernels kernels_ = kernels(choose_instruction_set());

  // the step at hand
  const Particles* particles_ = nullptr; // only while it goes on
  ShearingBox box_;
  double offset_ = 0.0;
  StraightLineTest test_;
  bool exactly_ = true;
  bool reaches_far_ = false;

  // the window
  int window_age_ = 0, window_ = 1;  // steps
  int run_ = 0, last_run_ = 1 << 20; // steps without a disturbance: up to now, and the last time
  Rotation to_window_;               // from this epoch to its middle,
  Instant at_window_;                // which is then
  LineFrame frame_{};                // of then
  FollowFrame follow_{};
  std::vector<Line> lines_; // by place
  std::vector<Pairs> near_;
  std::vector<std::uint32_t> touched_;   // who has been hit or listed anew in it
  std::vector<std::uint8_t> is_touched_; // of each particle whether
  std::vector<std::uint32_t> leaving_;   // who may leave its slack in it after the step at hand
  std::vector<std::uint8_t> is_leaving_; // of each particle that was hit in the step whether

  // the lists
  bool made_ = false;
  int age_ = 0, life_ = 1; // steps
  int next_life_ = 10;
  double slack_ = 0.0; // m
  LineCells cells_;
  std::vector<Line> references_; // by place; their size is radius, slack and curvature
  std::vector<Range> ranges_;
  std::vector<std::uint32_t> entries_;
  std::size_t entries_made_ = 0;      // when all were made
  std::vector<Pairs> pairs_;          // of then
  std::vector<std::uint32_t> anew_;   // who has been listed anew since,
  std::vector<std::uint8_t> is_anew_; // of each particle whether
  std::size_t times_anew_ = 0;        // how often that was
  double mean_radius_ = 0.0, min_radius_ = 0.0;

  // what the lists have cost since they were made, ns on a usual processor: the next life is chosen by it
  double cost_ = 0.0, last_cost_ = 0.0; // the latter a step
  double change_of_life_ = 1.4;         // at first in long strides
};

template<class Visit> void NeighbourLists::visit_block(std::size_t block, const Visit& visit) const {
  if (block < near_.size())
    visit_pairs(near_[block], [&](std::uint32_t i, std::uint32_t j, const Image& image) {
      if (!is_touched_[i] && !is_touched_[j])
        visit(i, j, image);
    });
  else {
    const std::size_t begin = (block - near_.size()) * few;
    visit_lists(std::span(touched_).subspan(begin, std::min(few, touched_.size() - begin)), is_touched_, visit);
  }
}

// The pairs of all lists of some, of which each marked one has all its pairs: those of two of them once.
template<class Visit>
void NeighbourLists::visit_lists(std::span<const std::uint32_t> of, const std::vector<std::uint8_t>& marked,
                                 const Visit& visit) const {
  std::size_t most = kernel_padding, count = 0;
  for (const std::uint32_t i : of)
    most += ranges_[i].count;
  Pairs pairs(most);
  for (const std::uint32_t i : of)
    for (const std::uint32_t j : list(i)) {
      pairs[count] = {i, j};
      count += !marked[j] || i < j;
    }
  pairs.resize(count + kernel_padding);
  visit_pairs(pairs, visit);
}

// Of these pairs, padded, those that may touch in the step.
template<class Visit> void NeighbourLists::visit_pairs(std::span<const LinePair> pairs, const Visit& visit) const {
  constexpr std::size_t chunk = 256;
  LinePair kept[chunk];
  const LineSpan span = in_step(-0.5 * step_, 0.5 * step_);
  const std::size_t count = pairs.size() - kernel_padding;
  for (std::size_t begin = 0; begin < count; begin += chunk) {
    const std::size_t some = std::min(chunk, count - begin);
    const std::size_t keeps = without(Acceleration::rejection)
                                  ? static_cast<std::size_t>(std::copy_n(pairs.data() + begin, some, kept) - kept)
                                  : kernels_.filter(lines_.data(), frame_, span, pairs.data() + begin, some, kept);
    for (std::size_t k = 0; k < keeps; ++k) {
      const auto [i, j] = kept[k];
      const Image image = nearest_image(i, j);
      if (!exactly_ || may_touch(i, j, image, -0.5 * step_))
        visit(i, j, image);
    }
  }
}

template<class Visit>
void NeighbourLists::visit_partners(std::size_t i, double start, double end, std::vector<std::uint32_t>& buffer,
                                    const Visit& visit) const {
  const Range& range = ranges_[i];
  if (buffer.size() < range.count)
    buffer.resize(2 * range.count);
  const std::uint32_t* const entries = entries_.data() + range.begin;
  const std::size_t count =
      without(Acceleration::rejection)
          ? static_cast<std::size_t>(std::copy_n(entries, range.count, buffer.data()) - buffer.data())
          : kernels_.sweep(lines_[i], lines_.data(), frame_, in_step(start, end), entries, range.count, buffer.data());
  for (std::size_t k = 0; k < count; ++k) {
    const Image image = nearest_image(i, buffer[k]);
    if (!exactly_ || may_touch(i, buffer[k], image, start))
      visit(buffer[k], image);
  }
}

template<class Visit> void NeighbourLists::visit_everywhere(std::size_t i, double start, const Visit& visit) const {
  const Body& body = particles_->bodies[i];
  const auto across = [&](double distance, double size) {
    return static_cast<std::int32_t>(std::ceil(distance / size)) + 1;
  };
  const Frequencies& f = frequencies_;
  for (std::size_t j = 0; j < particles_->size(); ++j) {
    if (j == i)
      continue;
    const Body& other = particles_->bodies[j];
    const Image nearest = nearest_image(body, other);
    const double e = body.elements.eccentricity() + other.elements.eccentricity();
    const double x = body.radius + other.radius + step_ * f.kappa * e;
    const double y = body.radius + other.radius + step_ * (f.shear() * (x + e) + 2.0 * e);
    throw_if_interrupted();
    require_reach(x, y, box_);
    const std::int32_t far_x = across(x, box_.size_x), far_y = across(y, box_.size_y);
    for (std::int32_t nx = -far_x; nx <= far_x; ++nx)
      for (std::int32_t ny = -far_y - std::abs(nx); ny <= far_y + std::abs(nx); ++ny) {
        const Image image{nearest.nx + nx, nearest.ny + ny};
        const Vec3 shift = box_.displacement(image, offset_);
        if (test_.may_touch(body, other, shift.x(), shift.y(), start))
          visit(j, image);
      }
  }
}

} // namespace keeler
