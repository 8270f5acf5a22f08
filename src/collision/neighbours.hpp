// Who may meet whom: candidate pairs from bounds, never from statistics, kept for a window of steps.
//
// At the first step of a window all particles go into a mirror, and every pair whose straight lines about the middle of
// the window may come into contact before it ends, with all that curvature, kicks (the skin) and rounding can add, goes
// into a list. Later steps of the window only go through the list. A particle that was hit has a new orbit: its entries
// die, and new ones are made after the step from what its new line can reach in the rest of the window. So at every
// step each pair that could touch is visited exactly once, and no result depends on the length of windows.
//
// The image of a partner is the nearest one. A box that is too small for that is a matter for grid_partners.hpp.
#pragma once

#include "crowd.hpp"
#include "mirror.hpp"
#include "reach.hpp"

#include <keeler/collision/straight_line.hpp>
#include <keeler/core/threads.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace keeler {

class Neighbours {
public:
  Neighbours(const Frequencies& frequencies, double step) : frequencies_(frequencies), step_(step) {}

  /// A step begins. Opens a new window unless the last one can go on: see moved_on(). Throws InvariantError when
  /// elements are not finite. Returns false when the box is so small that pairs may meet through several images.
  bool begin(const Particles& particles, const ShearingBox& box, double offset);

  /// The particles of the last step have moved on by exactly one step and been wrapped; nothing else but kicks happened
  /// to them.
  void moved_on() { goes_on_ = true; }
  /// Anything else has happened.
  void forget() { goes_on_ = false; }
  /// The same; the memory is not needed for a while.
  void release();
  /// Every particle has been kicked by at most this much (m rad⁻¹).
  void kicked(double largest);

  /// Calls visit(low, high, image of high) for every pair, the lower id first, that may touch in this step as long as
  /// nothing changes. Blocks, of which there are blocks(), may be visited by several threads.
  template<class Visit> void visit_block(std::size_t block, const Visit& visit) const;
  std::size_t blocks() const { return used_lists_; }
  /// The first of these are of the window's begin, in the order of places; the others are of later steps.
  std::size_t first_blocks() const { return first_lists_; }

  /// Whether a particle with a new orbit may meet others of the part through their nearest images only.
  bool one_image(const MirrorPart& part, std::size_t i) const { return mirror_.one_image(mirror_.line(i), part); }
  /// Calls visit(j, image of j) for every other particle that such a one may meet from `start` to the end of the step,
  /// as the store and the mirror know them. Looks around for the rest of the window at once, so that settle() need not
  /// do so again; returns how many may be met in it, itself included. The part encloses it, and the looker is that
  /// part's.
  template<class Visit>
  std::size_t visit_partners(const MirrorPart& part, std::size_t looker, std::size_t i, double start,
                             std::vector<std::uint32_t>& buffer, const Visit& visit);
  /// The same for an orbit so fast that it may meet others through several images: all of all particles are tried.
  template<class Visit> void visit_everywhere(std::size_t i, double start, const Visit& visit) const;
  /// Calls visit(j) for every other particle that particle i may meet from `start` to the end of the step when j has
  /// been no farther than this (m) off its present path.
  template<class Visit>
  void visit_around(const MirrorPart& part, std::size_t i, double start, double off, std::vector<std::uint32_t>& buffer,
                    const Visit& visit) const;

  /// Calls visit(image of b) for the nearest image if it may touch from `start` to the end of the step. For orbits
  /// that visit_partners() takes.
  template<class Visit> void visit_nearest(const Body& a, const Body& b, double start, const Visit& visit) const {
    const Image image = nearest_image(a, b);
    const Vec3 shift = box_.displacement(image, offset_);
    if (step_test_.may_touch(a, b, shift.x(), shift.y(), start))
      visit(image);
  }
  /// The same when it may also touch in the `time` after `begin`, short beside the step.
  template<class Visit>
  void visit_nearest_soon(const Body& a, const Body& b, double start, const Rotation& begin, double time,
                          const Visit& visit) const {
    const Image image = nearest_image(a, b);
    const Vec3 shift = box_.displacement(image, offset_);
    if (step_test_.may_touch_soon(a, b, shift.x(), shift.y(), begin, time) &&
        step_test_.may_touch(a, b, shift.x(), shift.y(), start))
      visit(image);
  }
  static constexpr std::size_t fewest_in_crowd = 32; ///< for it to be of use
  /// Takes everybody into the crowd of particle i that it may meet from `start` to the end of the step. Returns false
  /// when they are too few, or when the orbit of i is too fast.
  bool gather(std::size_t i, double start, std::vector<std::uint32_t>& buffer, Crowd& crowd) const;
  /// Whether a crowd still serves: the centre keeps to its path, and nearest images are all that it may meet.
  bool holds(const Crowd& crowd) const {
    return departure(crowd.change()) < crowd.margin() && one_image(mirror_.whole(), crowd.centre());
  }
  /// No two paths that differ by these elements are farther apart at any time of the step, m.
  double departure(const Elements& el) const {
    const Frequencies& f = frequencies_;
    const double half = 0.5 * step_;
    const double off =
        std::fabs(el.guiding_x - el.e_cos) + std::fabs(el.guiding_y + (2.0 / f.kappa) * el.e_sin) + std::fabs(el.i_sin);
    const double speed = f.kappa * std::fabs(el.e_sin) + std::fabs(2.0 * el.e_cos - f.shear() * el.guiding_x) +
                         f.nu * std::fabs(el.i_cos);
    const double acceleration = 2.0 * f.kappa * (std::fabs(el.e_cos) + std::fabs(el.e_sin)) +
                                f.nu * f.nu * (std::fabs(el.i_sin) + std::fabs(el.i_cos));
    return off + half * (speed + 0.5 * half * acceleration);
  }

  const Mirror& mirror() const { return mirror_; }
  Line line_of(const Body& body) const { return mirror_.line_of(body, to_middle_); }

  /// Those who look around in this step: number 0 in the whole, others each in a part, at the same time as long as
  /// parts do not overlap. Of two parts that do, the one with the higher number comes later.
  static constexpr std::size_t most_lookers = 256;
  void set_lookers(std::size_t count);

  /// A particle has been hit and has a new orbit. May be called several times a step; contacts make two calls each.
  void changed(MirrorPart& part, std::size_t looker, std::size_t i);
  MirrorPart& whole() { return mirror_.whole(); }
  /// To undo that, when the particle has its orbit of before again: the mark of before.
  struct Mark {
    std::uint32_t look;
    std::uint8_t changed;
  };
  Mark mark(std::size_t i) const { return {mirror_.note(i), changed_[i]}; }
  void restore(MirrorPart& part, std::size_t i, Mark mark);
  /// Three calls for a place, some time apart, bring what a hit needs into the cache.
  void prefetch(std::size_t i, int stage) const {
    if (stage == 0)
      __builtin_prefetch(&changed_[i], 1);
    mirror_.prefetch(i, stage);
  }
  /// The whole learns what a part has changed.
  void join(const MirrorPart& part) { mirror_.join(part); }

  /// The step's collisions are over, so many: what these particles may meet in the rest of the window. Each particle
  /// that was changed once. Meanwhile one of the threads calls `beside`, once.
  void settle(std::span<const std::uint32_t> particles, std::uint64_t collisions, const std::function<void()>& beside);

  std::uint64_t windows = 0, tested = 0, listed = 0; ///< so far
  std::size_t bytes() const;

private:
  static constexpr std::size_t block_size = 1024; // slots

  /// Places, the lower id first. Alive as long as neither has changed since it was made.
  struct Entry {
    std::uint32_t low, high;
  };
  struct alignas(64) List {
    std::vector<Entry> entries;
    std::uint8_t made = 0; // after so many steps of the window
  };

  void open();
  bool relist(std::span<const std::uint32_t> particles, std::vector<Entry>& list);
  bool looks_needed() const { return at_step_ + 1 < length_; } // by later steps of the window
  void choose_length();
  double cost_of(int length) const;
  double skin_for(int length) const;
  void list_pairs();
  void use_lists(std::size_t count);
  Entry entry(std::size_t i, std::size_t j) const {
    const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>(j);
    return particles_->ids[i] < particles_->ids[j] ? Entry{a, b} : Entry{b, a};
  }
  double since_middle() const { return (at_step_ + 0.5 - 0.5 * length_) * step_; } // of the window, to this epoch
  Image nearest_image(const Body& a, const Body& b) const;
  // Whether i lists the pair, of two that were hit in this step: if it was the last to be, and so has seen the other's
  // present line; i and j have seen each other's when they met.
  bool lists(std::uint32_t i, std::uint32_t j) const {
    const std::uint32_t contact_i = mirror_.note(i) / 2, contact_j = mirror_.note(j) / 2;
    return contact_i != contact_j ? contact_i > contact_j : i < j;
  }
  LineSpan span(double begin, double end) const {
    const double rounding = 1e-6 * length_ * step_;
    return {static_cast<float>(begin - rounding), static_cast<float>(end + rounding)};
  }

  Frequencies frequencies_;
  double step_;
  const Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;

  // the window
  bool goes_on_ = false; // the promise of moved_on()
  bool over_ = false;    // it ends with this step
  int at_step_ = 0, length_ = 0;
  Mirror mirror_;
  Rotation to_middle_;                // from this step's epoch
  std::vector<std::uint8_t> changed_; // 1 + the step of the window in which each particle was last hit; or 0
  // Of this step: what was seen after each change, of which each contact makes two. Each particle's last look is noted
  // in the mirror: the looker, and the number among its looks.
  struct Look {
    std::uint32_t begin = 0, end = 0; // of `seen`; from zero: nobody has looked
  };
  struct alignas(64) Looks { // two threads share no line of cache
    std::vector<Look> made;
    std::vector<std::uint32_t> seen; // places
    bool too_many = false;
  };
  static constexpr std::uint32_t most_looks = 1u << 24; // of one looker
  std::vector<Looks> looks_;
  Look& look(std::size_t i) {
    const std::uint32_t number = mirror_.note(i);
    return looks_[number / most_looks].made[number % most_looks];
  }
  std::vector<List> lists_; // of which so many are of this window; the others keep their memory
  std::size_t used_lists_ = 0, first_lists_ = 0;
  double kick_path_ = 0.0, skin_ = 0.0; // how far kicks may have moved a particle; how far the lists allow
  double last_kick_ = 0.0;
  std::uint64_t hits_ = 0;
  double last_tested_ = 0.0, last_listed_ = 0.0; // pairs a particle, when the window began
  StraightLineTest step_test_;
};

template<class Visit> void Neighbours::visit_block(std::size_t block, const Visit& visit) const {
  constexpr std::size_t ahead = 12; // entries
  const auto& [list, made] = lists_[block];
  const std::vector<Body>& bodies = particles_->bodies;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (k + ahead < list.size()) {
      __builtin_prefetch(&bodies[list[k + ahead].low]);
      __builtin_prefetch(&bodies[list[k + ahead].high]);
    }
    const Entry e = list[k];
    if (changed_[e.low] <= made && changed_[e.high] <= made)
      visit_nearest(bodies[e.low], bodies[e.high], -0.5 * step_,
                    [&](const Image& image) { visit(e.low, e.high, image); });
  }
}

template<class Visit>
std::size_t Neighbours::visit_partners(const MirrorPart& part, std::size_t looker, std::size_t i, double start,
                                       std::vector<std::uint32_t>& buffer, const Visit& visit) {
  const Line& line = mirror_.line(i);
  const Body& body = particles_->bodies[i];
  const LineSpan rest = span(since_middle() + start, 0.5 * length_ * step_);
  const std::size_t count = mirror_.near(part, line, rest, buffer);
  std::vector<std::uint32_t>* const seen = looks_needed() ? &looks_[looker].seen : nullptr;
  if (seen)
    look(i).begin = static_cast<std::uint32_t>(seen->size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t j = mirror_.place(buffer[k]);
    if (j == i)
      continue;
    if (seen)
      seen->push_back(j);
    visit_nearest(body, particles_->bodies[j], start, [&](const Image& image) { visit(j, image); });
  }
  if (seen)
    look(i).end = static_cast<std::uint32_t>(seen->size());
  return count;
}

template<class Visit>
void Neighbours::visit_around(const MirrorPart& part, std::size_t i, double start, double off,
                              std::vector<std::uint32_t>& buffer, const Visit& visit) const {
  Line line = mirror_.line(i);
  line.size += static_cast<float>(1.001 * off);
  const double now = since_middle();
  const std::size_t count = mirror_.near(part, line, span(now + start, now + 0.5 * step_), buffer);
  for (std::size_t k = 0; k < count; ++k)
    if (const std::size_t j = mirror_.place(buffer[k]); j != i)
      visit(j);
}

template<class Visit> void Neighbours::visit_everywhere(std::size_t i, double start, const Visit& visit) const {
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
        if (step_test_.may_touch(body, other, shift.x(), shift.y(), start))
          visit(j, image);
      }
  }
}

} // namespace keeler
