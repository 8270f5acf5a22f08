// Common parts of the finders of the published code (M. C. Lewis, HardSphereCollSims, 2023): its constants and its exit
// codes. Its results are kept, with these exceptions, each because Keeler searches again after a pair has just
// collided, which that code does not:
//   - a pair that overlaps and recedes is receding for every finder (there, linear-full reports an event);
//   - relative rest (f′ = 0) is receding, not a first guess at infinity;
//   - an event for an overlapping pair beyond the end of the step is moved to the start of the span.
// Its costs differ in some respects: there the original's trials need no velocities (six sines and cosines, here
// eight), linear-cubic evaluates each accepted guess once more, and both cubic ones use two cubics, not their
// difference.
#pragma once

#include <keeler/finders/pair.hpp>

#include <cmath>

namespace keeler::finders {

struct Published {
  static constexpr double convergence = 1e-8;  ///< a root has |d² − R²| below this many R²
  static constexpr int iterations = 50;        ///< passes of the loop
  static constexpr int halvings = 15;          ///< of one step
  static constexpr double farthest = 5.0;      ///< steps: largest distance of a guess from the step's start
  static constexpr double min_move = 1e-8;     ///< steps: a shorter move to a closest approach counts as none
  static constexpr int closest_moves = 25;     ///< moves to a closest approach in one search
  static constexpr double hopeless = 2.0;      ///< R²: a closest approach with a larger d² ends linear-full
  static constexpr double overlap_step = 1e-4; ///< steps from the start of the span to the event of an overlapping pair
  static constexpr double overlap_radius = 1e-3; ///< linear-full later in a step: as the time to cover this fraction of
                                                 ///< the smaller radius
};

/// The exit codes of its finders.
enum class PublishedExit {
  root = 0,
  iterations = 1, ///< fifty passes
  overlapping_receding = 2,
  receding = 3,
  overlapping = 4,  ///< and approaching
  too_early = 5,    ///< guess before −5 h
  too_late = 6,     ///< guess after 5 h
  halvings = 7,     ///< fifteen of one step
  no_movement = 8,  ///< towards a closest approach; or a closest approach beyond `hopeless`
  closest_moves = 9 ///< too many of them
};

/// Codes 5, 6 and 8 are the finder's decision that there is no contact; 1, 7 and 9 decide nothing.
constexpr FinderExit exit_of(PublishedExit code) {
  switch (code) {
  case PublishedExit::root:
    return FinderExit::hit; // `outside` if its time is not in the span: see MotionSearch
  case PublishedExit::overlapping_receding:
  case PublishedExit::receding:
    return FinderExit::receding;
  case PublishedExit::overlapping:
    return FinderExit::overlapping;
  case PublishedExit::too_early:
  case PublishedExit::too_late:
  case PublishedExit::no_movement:
    return FinderExit::missed;
  default:
    return FinderExit::gave_up;
  }
}

inline FinderResult& leave(FinderResult& result, PublishedExit code) {
  result.exit = exit_of(code);
  return result;
}

inline bool is_number(const Separation& s) {
  return std::isfinite(s.d.squaredNorm()) && std::isfinite(s.closing());
}

inline FinderResult& not_a_number(FinderResult& result) {
  result.exit = FinderExit::not_a_number;
  return result;
}

/// Reports the event of an overlapping pair: `delay` after the start of the span, or at once if that is past its end.
inline FinderResult& overlap(FinderResult& result, const Pair& pair, double delay) {
  const double time = pair.start + delay;
  result.time = time < pair.end ? time : pair.start;
  return leave(result, PublishedExit::overlapping);
}

/// True if |d² − R²| is within the tolerance of a root.
inline bool is_root(const Separation& s, double radius_sum) {
  return std::fabs(s.gap(radius_sum)) < Published::convergence * radius_sum * radius_sum;
}

/// Halves a step from `guess` while the trial at its end is `worse`; false after the last halving allowed.
template<class Motion, class Worse>
bool damp(Motion& motion, double guess, double& step, Separation& trial, FinderResult& result, const Worse& worse) {
  for (int halvings = 0; worse(trial);) {
    step *= 0.5;
    trial = motion.at(guess + step);
    ++result.evaluations;
    ++result.halvings;
    if (++halvings == Published::halvings)
      return false;
  }
  return true;
}

/// True if the step is so long that the allowed halvings cannot bring it back in range: its sine would be meaningless.
inline bool leads_nowhere(double step, const Pair& pair) {
  return !(std::fabs(step) < std::ldexp(2.0 * Published::farthest * pair.step, Published::halvings));
}

/// True if a guess is out of range; the result is then complete.
inline bool out_of_range(double guess, const Pair& pair, FinderResult& result) {
  const double since_begin = guess - (pair.end - pair.step), range = Published::farthest * pair.step;
  if (std::fabs(since_begin) <= range)
    return false;
  leave(result, since_begin > 0.0 ? PublishedExit::too_late : PublishedExit::too_early);
  return true;
}

} // namespace keeler::finders
