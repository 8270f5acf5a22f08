// A finder: a form of motion (concept MotionModel) under a form of search (concept SearchMethod), with what the motion
// keeps for each particle through a step. A new finder is one such file and one line in src/finders/finders.cpp:
// docs/dev/finders.md shows one.
#pragma once

#include <keeler/core/parallel.hpp>
#include <keeler/finders/pair.hpp>
#include <keeler/finders/straight_line.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cassert>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keeler::finders {

/// One step as seen by finders. Times are relative to the epoch of the elements, rad. Precondition: begin <= end.
struct DriftStep {
  std::span<const Body> bodies;
  Frequencies frequencies;
  double begin = 0.0, end = 0.0;
  Rotation at_begin, at_end;
  StraightLineTest straight_line;
  bool tested = false; ///< straight lines have already excluded most pairs: another test does not pay

  /// `size`: largest coordinate, m; sets the allowance for rounding.
  DriftStep(const Frequencies& f, double begin_time, double end_time, double size)
      : frequencies(f), begin(begin_time), end(end_time), at_begin(f, begin_time), at_end(f, end_time) {
    assert(!(begin > end));
    straight_line = {f, end, std::max(std::fabs(begin), std::fabs(end)), 1e-13 * size};
  }
};

/// Two particles (indices into the store; `low` has the lower id), the shift of the image of `high` at the epoch, and
/// the begin of the search.
struct Query {
  std::uint32_t low = 0, high = 0;
  double shift_x = 0.0, shift_y = 0.0; ///< m
  double start = 0.0;                  ///< rad
};

inline bool may_touch(const Query& q, const Body& low, const Body& high, const DriftStep& s) {
  return s.straight_line.may_touch(low, high, q.shift_x, q.shift_y, q.start);
}

inline Pair pair_of(const Query& q, const Body& low, const Body& high, const DriftStep& s) {
  Pair pair;
  pair.lo = low.elements;
  pair.hi = high.elements;
  pair.hi.guiding_x += q.shift_x;
  pair.hi.guiding_y += q.shift_y;
  pair.shift_x = q.shift_x;
  pair.shift_y = q.shift_y;
  pair.radius_sum = low.radius + high.radius;
  pair.smaller = std::min(low.radius, high.radius);
  pair.start = q.start;
  pair.end = s.end;
  pair.step = s.end - s.begin;
  return pair;
}

inline Pair pair_of(const Query& q, const DriftStep& s) {
  assert(q.low < s.bodies.size() && q.high < s.bodies.size());
  return pair_of(q, s.bodies[q.low], s.bodies[q.high], s);
}

/// Returns the state of the image of `hi` minus that of the particle at a time: images drift with the shear, exactly.
inline State image_offset(const Pair& pair, const Frequencies& f, double time) {
  const double drift = -f.shear() * pair.shift_x;
  return {Vec3(pair.shift_x, pair.shift_y + drift * time, 0.0), Vec3(0.0, drift, 0.0)};
}

/// Returns the separation at the start of the span, from stored data if available, else by an evaluation, counted.
template<class Motion> Separation first_separation(Motion& motion, const Pair& pair, FinderResult& result) {
  if constexpr (requires { motion.at_start(); })
    if (const std::optional<Separation> kept = motion.at_start())
      return *kept;
  ++result.evaluations;
  return motion.at(pair.start);
}

class Finder {
public:
  virtual ~Finder() = default;

  /// Begins a step. The step and its particles must stay in place until the next call.
  virtual void begin(const DriftStep& step) = 0;

  /// Updates stored data after a change of a particle's velocity. Precondition: begin() was called.
  virtual void changed(std::size_t particle) = 0;

  /// Finds a contact in [query.start, end of the step); a root elsewhere is reported as `outside`. Precondition:
  /// begin() was called.
  virtual FinderResult find(const Query& query) const = 0;

  /// Answers many queries, bit-identical to find(), in their order. Precondition: one result per query.
  virtual void find_all(std::span<const Query> queries, std::span<FinderResult> results) const {
    assert(results.size() == queries.size());
    for (std::size_t k = 0; k < queries.size(); ++k)
      results[k] = find(queries[k]);
  }

  /// True if the finder stores nothing per particle, never gives up and never errs. Only such a finder may be called
  /// for orbits other than the step's, by several threads.
  virtual bool exact() const { return false; }
  /// As find(), for these orbits in place of the step's. Precondition: exact().
  virtual FinderResult find_between(const Query&, const Body& /*low*/, const Body& /*high*/) const {
    assert(!exact());
    return {};
  }

  /// Returns the size of the data stored per particle beyond its elements.
  virtual std::size_t bytes_per_particle() const = 0;
};

/// A motion that keeps something for each particle through a step: a Memory, made from its elements.
template<class Motion>
concept RemembersParticles = requires(const Elements& elements, const DriftStep& step) {
  typename Motion::Memory;
  { Motion::remember(elements, step) } -> std::same_as<typename Motion::Memory>;
};

/// A motion that can prove a miss before a pair is set up.
template<class Motion>
concept RejectsPairs = requires(const Query& query, const Body& body, const DriftStep& step) {
  { Motion::surely_apart(query, body, body, step) } -> std::same_as<bool>;
};

/// A motion that is made from a pair, the step and, if it keeps them, the memories of both particles.
template<class Motion>
concept MadeFromPair = std::constructible_from<Motion, const Pair&, const DriftStep&> ||
    (RemembersParticles<Motion>&& std::constructible_from<
        Motion, const Pair&, const DriftStep&, const typename Motion::Memory&, const typename Motion::Memory&>);

/// The relative path of two particles; at(time) is one evaluation. It may also have at_start(), an optional separation
/// at pair.start from what it keeps, without an evaluation.
template<class Motion>
concept MotionModel = MadeFromPair<Motion> && requires(Motion& motion, double time) {
  { motion.at(time) } -> std::same_as<Separation>;
};

/// The way from guesses to the first contact. A search that never errs and never gives up also has
/// `static constexpr bool exact = true`.
template<class Search, class Motion>
concept SearchMethod = requires(Motion& motion, const Pair& pair) {
  { Search::find(motion, pair) } -> std::same_as<FinderResult>;
};

template<MotionModel Motion, SearchMethod<Motion> Search> class MotionSearch final : public Finder {
public:
  void begin(const DriftStep& step) override {
    step_ = &step;
    if constexpr (remembers) {
      memories_.resize(step.bodies.size());
      parallel_for(memories_.size(), [&](std::size_t k) { changed(k); });
    }
  }

  void changed([[maybe_unused]] std::size_t k) override {
    assert(step_ != nullptr && k < step_->bodies.size());
    if constexpr (remembers)
      memories_[k] = Motion::remember(step_->bodies[k].elements, *step_);
  }

  FinderResult find(const Query& query) const override {
    assert(step_ != nullptr && query.low < step_->bodies.size() && query.high < step_->bodies.size());
    return find_between(query, step_->bodies[query.low], step_->bodies[query.high]);
  }

  bool exact() const override {
    if constexpr (requires { Search::exact; })
      return !remembers;
    else
      return false;
  }

  FinderResult find_between(const Query& query, const Body& low, const Body& high) const override {
    if constexpr (RejectsPairs<Motion>)
      if (Motion::surely_apart(query, low, high, *step_))
        return {};
    const Pair pair = pair_of(query, low, high, *step_);
    Motion motion = motion_of(pair, query);
    FinderResult result = Search::find(motion, pair);
    if (result.contact() && !(result.time >= pair.start && result.time < pair.end))
      result.exit = FinderExit::outside;
    return result;
  }

  std::size_t bytes_per_particle() const override {
    if constexpr (remembers)
      return sizeof(typename Motion::Memory);
    else
      return 0;
  }

private:
  static constexpr bool remembers = RemembersParticles<Motion>;
  struct Nothing {};
  template<class M> struct MemoryOf { using Type = Nothing; };
  template<RemembersParticles M> struct MemoryOf<M> { using Type = typename M::Memory; };

  Motion motion_of(const Pair& pair, [[maybe_unused]] const Query& query) const {
    if constexpr (remembers)
      return Motion(pair, *step_, memories_[query.low], memories_[query.high]);
    else
      return Motion(pair, *step_);
  }

  const DriftStep* step_ = nullptr;
  std::vector<typename MemoryOf<Motion>::Type> memories_;
};

} // namespace keeler::finders
