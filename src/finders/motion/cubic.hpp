// Motion, form "cubic": Hermite cubics through positions and velocities at the two ends of the step. They differ from
// the epicycle by at most h⁴/384 max|x⁗| per axis, and need no sine or cosine once fitted.
//   CubicMotion        fitted per pair before any test, with both particles' own sines and cosines: 16 values
//   LateCubicMotion    the full motion at the start of the span (8 values); fitted (16 more) if the search moves on
//   CachedCubicMotion  fitted per particle, once per step and after each velocity change, with the common rotations
#pragma once

#include <keeler/finders/motion/full.hpp>

#include <cassert>
#include <optional>

namespace keeler::finders {

/// A vector cubic in the time u since the step's start.
struct Cubic {
  Vec3 c0, c1, c2, c3;

  /// Returns the cubic through the states at u = 0 and u = h. Precondition: h > 0.
  static Cubic through(const State& begin, const State& end, double h) {
    assert(h > 0.0);
    const Vec3 slope = (end.position - begin.position) / h;
    return {begin.position, begin.velocity, (3.0 * slope - 2.0 * begin.velocity - end.velocity) / h,
            (begin.velocity + end.velocity - 2.0 * slope) / (h * h)};
  }

  Separation at(double u) const { return {c0 + u * (c1 + u * (c2 + u * c3)), c1 + u * (2.0 * c2 + u * (3.0 * c3))}; }
};

inline Cubic operator-(const Cubic& b, const Cubic& a) {
  return {b.c0 - a.c0, b.c1 - a.c1, b.c2 - a.c2, b.c3 - a.c3};
}

class CubicMotion {
public:
  CubicMotion(const Pair& pair, const DriftStep& step)
      : begin_(step.begin), cubic_(fitted(pair.hi, step) - fitted(pair.lo, step)) {}

  Separation at(double time) const { return cubic_.at(time - begin_); }

private:
  static Cubic fitted(const Elements& el, const DriftStep& step) {
    const Frequencies& f = step.frequencies;
    return Cubic::through(state_at(el, f, own_rotation(f, step.begin)), state_at(el, f, own_rotation(f, step.end)),
                          step.end - step.begin);
  }

  double begin_;
  Cubic cubic_;
};

class LateCubicMotion : public FullMotion {
public:
  LateCubicMotion(const Pair& pair, const DriftStep& step) : FullMotion(pair, step), step_(step) {}

  Separation at(double time) {
    if (!cubic_) {
      if (time == pair_.start)
        return FullMotion::at(time);
      cubic_.emplace(pair_, step_);
    }
    return cubic_->at(time);
  }

private:
  const DriftStep& step_;
  std::optional<CubicMotion> cubic_;
};

class CachedCubicMotion {
public:
  using Memory = Cubic;

  static Memory remember(const Elements& el, const DriftStep& step) {
    return Cubic::through(state_at(el, step.frequencies, step.at_begin), state_at(el, step.frequencies, step.at_end),
                          step.end - step.begin);
  }

  CachedCubicMotion(const Pair& pair, const DriftStep& step, const Memory& lo, const Memory& hi)
      : begin_(step.begin), cubic_(hi - lo) {
    const State image = image_offset(pair, step.frequencies, begin_);
    cubic_.c0 += image.position;
    cubic_.c1 += image.velocity;
  }

  Separation at(double time) const { return cubic_.at(time - begin_); }

private:
  double begin_;
  Cubic cubic_;
};

} // namespace keeler::finders
