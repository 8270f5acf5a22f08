// Motion, form "relative epicycle": the relative orbit of two particles is an epicycle of the differences of their
// elements, so a guess needs only one sine and cosine, and its speed and acceleration are bounded at all times.
// BoundedMotion is this path with these bounds, and straight lines prove most misses before it is set up.
#pragma once

#include <keeler/finders/finder.hpp>

#include <algorithm>
#include <limits>

namespace keeler::finders {

class RelativeMotion {
public:
  RelativeMotion(const Pair& pair, const DriftStep& step)
      : elements_(pair.hi - pair.lo), frequencies_(step.frequencies) {}

  Separation at(double time) const {
    const State s = state_at(elements_, frequencies_, Rotation(frequencies_, time));
    return {s.position, s.velocity};
  }

protected:
  Elements elements_;
  Frequencies frequencies_;
};

class BoundedMotion : public RelativeMotion {
public:
  static bool surely_apart(const Query& query, const Body& low, const Body& high, const DriftStep& step) {
    return !step.tested && !may_touch(query, low, high, step);
  }

  BoundedMotion(const Pair& pair, const DriftStep& step) : RelativeMotion(pair, step) {
    const Frequencies& f = frequencies_;
    const double e = elements_.eccentricity(), i = elements_.inclination();
    const double horizontal = f.shear() * std::fabs(elements_.guiding_x) + 2.0 * e;
    constexpr double up = 1.0 + 1e-14; // keeps the bounds valid after rounding
    speed_ = up * std::sqrt(horizontal * horizontal + f.nu * f.nu * i * i);
    acceleration_ = up * std::hypot(2.0 * f.kappa * e, f.nu * f.nu * i);
    scale_ = std::max({std::fabs(elements_.guiding_x), std::fabs(elements_.guiding_y), 2.0 * e / f.kappa, i});
  }

  double largest_speed() const { return speed_; }               ///< V: |v| <= V at all times (κ <= 2)
  double largest_acceleration() const { return acceleration_; } ///< A: |a| <= A at all times

  /// Returns a bound on the rounding error of |d|² − R² as evaluated from the elements.
  double gap_error(double distance, double radius_sum) const {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    return 4.0 * ulp * (distance * distance + radius_sum * radius_sum + 4.0 * distance * scale_);
  }

  /// Returns a bound on the rounding error of 2 d·v.
  double closing_error(double distance, double speed) const {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    return 32.0 * ulp * (distance * speed + distance * speed_ + speed * scale_);
  }

private:
  double speed_, acceleration_, scale_;
};

} // namespace keeler::finders
