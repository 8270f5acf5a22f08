// Search, form "certified": steps that provably never pass the first root of f = |d|² − R².
//
// With |v| <= V and |a| <= A for all times, over a remaining span s from a point with distance |d| and speed |v|,
//   f'' = 2|v|² + 2 d·a >= m = 2 max(0, |v| − A s)² − 2 (|d| + V s) A,
// so f(t + τ) >= f + f' τ + m τ²/2: the first root of that parabola, if any is in the span, is a safe step, and it
// converges quadratically on simple roots. If |f| is within its rounding error the pair is in contact: approaching, the
// event is now; receding, the first possible turning point −f'/m is the next safe step.
// All roundings are directed to the safe side: f, f' and m down, V and A up, the step down.
//
// Near contact, within rounding, the steps would shrink to noise (a pair at constant distance never leaves it). There a
// step may let f decrease by one rounding error, and by one more per 1024 passes. So every search ends, and no
// contact deeper than 2 δ (1 + passes/1024) is missed, with δ = gap_error: docs/theory/finders.md has the proof.
#pragma once

#include <keeler/finders/finder.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <concepts>

namespace keeler::finders {

/// A motion with bounds on its speed and acceleration at all times, and on the rounding of |d|² − R² and of 2 d·v.
template<class Motion>
concept BoundedMotionModel = MotionModel<Motion> && requires(const Motion& motion, double x) {
  { motion.largest_speed() } -> std::same_as<double>;
  { motion.largest_acceleration() } -> std::same_as<double>;
  { motion.gap_error(x, x) } -> std::same_as<double>;
  { motion.closing_error(x, x) } -> std::same_as<double>;
};

struct CertifiedSearch {
  static constexpr bool exact = true;
  template<BoundedMotionModel Motion> static FinderResult find(const Motion& motion, const Pair& pair);
};

template<BoundedMotionModel Motion> FinderResult CertifiedSearch::find(const Motion& motion, const Pair& pair) {
  constexpr double down = 1.0 - 1e-13;
  constexpr int patience = 8; // consecutive short steps before the window is halved: bounds over it are tighter
  const double speed_bound = motion.largest_speed(), acceleration_bound = motion.largest_acceleration();

  assert(!(pair.start > pair.end));
  FinderResult result;
  double t = pair.start;
  double window = pair.end - pair.start; // largest span of a bound
  bool at_start = true;
  int short_steps = 0;
  while (true) {
    const Separation now = motion.at(t);
    ++result.evaluations;
    const double distance = now.d.norm(), speed = now.v.norm();
    const double f = now.gap(pair.radius_sum), slope = now.closing();
    const double error = motion.gap_error(distance, pair.radius_sum);
    if (!std::isfinite(f) || !std::isfinite(slope)) {
      result.exit = FinderExit::not_a_number;
      return result;
    }
    if (f <= error && slope < 0.0) {
      result.exit = at_start ? FinderExit::overlapping : FinderExit::hit;
      result.time = t;
      return result;
    }

    const double s = std::min(window, pair.end - t);
    const double slower = std::max(0.0, speed * down - acceleration_bound * s);
    const double positive = 2.0 * slower * slower, negative = 2.0 * (distance + speed_bound * s) * acceleration_bound;
    const double m = positive * down - negative / down; // f'' >= m over the next s
    const int thousands = result.iterations / 1024;
    const double tolerance = error * (1.0 + thousands);
    const double low_slope = slope - motion.closing_error(distance, speed);

    double step; // no contact before t + step; infinite if there is none within s
    if (f <= error) {
      step = m >= 0.0 ? HUGE_VAL : std::max(0.0, slope) / -m + std::sqrt(2.0 * tolerance / -m);
    } else {
      const double low_f = std::max(f - error, tolerance);
      const double discriminant = low_slope * low_slope - 2.0 * m * low_f;
      if (m >= 0.0 && (low_slope >= 0.0 || discriminant < 0.0))
        step = HUGE_VAL;
      else if (low_slope < 0.0)
        step = 2.0 * low_f / (-low_slope + std::sqrt(discriminant));
      else
        step = (low_slope + std::sqrt(discriminant)) / -m;
    }
    step *= down;

    if (step >= s && s >= pair.end - t) {
      result.exit = at_start && slope >= 0.0 ? FinderExit::receding : FinderExit::missed;
      return result;
    }
    const double next = t + std::min(step, s);
    if (next == t && slope < 0.0) { // the root is between t and the next double
      result.exit = at_start ? FinderExit::overlapping : FinderExit::hit;
      result.time = t;
      return result;
    }
    t = next > t ? next : std::nextafter(t, HUGE_VAL);
    if (t >= pair.end) {
      result.exit = FinderExit::missed;
      return result;
    }
    at_start = false;
    ++result.iterations;
    if (step >= s) {
      window *= 2.0;
      short_steps = 0;
    } else if (++short_steps % patience == 0) {
      window *= 0.5;
    }
  }
}

} // namespace keeler::finders
