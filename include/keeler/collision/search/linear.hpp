// Search, form "linear" (the paper's fastest): the next guess is where straight lines from the present guess would
// touch, or else their closest approach. Its limits are those of the paper's code; it can miss a contact.
#pragma once

#include <keeler/collision/finder.hpp>

#include <cmath>

namespace keeler {

/// Constants of the published code (HardSphereCollSims, 2023).
struct LinearLimits {
  static constexpr double convergence = 1e-8; ///< of |d² − R²|, in R²
  static constexpr int iterations = 50;
  static constexpr int closest_moves = 25;   ///< moves to a closest approach before giving up
  static constexpr double least_move = 1e-8; ///< of the step
  static constexpr double farthest = 5.0;    ///< steps from the step's start
  static constexpr double hopeless = 2.0;    ///< gives up when a closest approach has d² beyond this many R²
};

struct LinearSearch {
  template<class Motion> static FinderResult find(Motion& motion, const Pair& pair);
};

template<class Motion> FinderResult LinearSearch::find(Motion& motion, const Pair& pair) {
  using L = LinearLimits;
  const double reach2 = pair.reach * pair.reach, step_start = pair.end - pair.step;
  FinderResult result;
  result.time = pair.start;
  Separation now = first_separation(motion, pair, result);
  if (!std::isfinite(now.gap(pair.reach)) || !std::isfinite(now.closing())) {
    result.exit = FinderExit::not_a_number;
    return result;
  }
  if (now.closing() >= 0.0) {
    result.exit = FinderExit::receding;
    return result;
  }
  if (now.d.squaredNorm() <= reach2 * (1.0 + L::convergence)) {
    result.exit = FinderExit::overlapping;
    return result;
  }

  double t = pair.start;
  int closest_moves = 0;
  result.exit = FinderExit::gave_up;
  for (; result.iterations < L::iterations; ++result.iterations) {
    const double v2 = now.v.squaredNorm(), dv = now.d.dot(now.v);
    const double discriminant = dv * dv - v2 * now.gap(pair.reach);
    const bool touches = discriminant >= 0.0;
    const double move = touches ? (-dv - std::sqrt(discriminant)) / v2 : -dv / v2;
    if (!touches && (++closest_moves > L::closest_moves || std::fabs(move) < L::least_move * pair.step))
      return result;
    t += move;
    if (!(std::fabs(t - step_start) <= L::farthest * pair.step)) {
      result.exit = FinderExit::missed;
      return result;
    }
    now = motion.at(t);
    ++result.evaluations;
    if (std::fabs(now.gap(pair.reach)) < L::convergence * reach2 && now.closing() < 0.0) {
      const bool in_span = t >= pair.start && t < pair.end;
      result.exit = in_span ? FinderExit::hit : FinderExit::missed;
      result.time = t;
      return result;
    }
    if (!touches && now.d.squaredNorm() > L::hopeless * reach2)
      return result;
  }
  return result;
}

} // namespace keeler
