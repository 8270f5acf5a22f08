// The certified twin of the finders: proves from polynomials that a pair does not sink into contact over a whole span.
//
// On [c − w, c + w] each coordinate is its Taylor polynomial in u = (t − c)/w with Lagrange's remainder, so
// f = |d|² − R² is a polynomial P of degree 2p within an error that is known. The coefficients of P in Bernstein form
// bound it from both sides (Farouki & Rajan 1987); the coefficients of P′ and P″ are their differences. Therefore
//   P >= the smallest coefficient; P monotone or concave => minimum at an end; P convex => P >= any of its tangents.
// Undecided intervals are halved. Extended precision throughout; only the elements are common with the finders.
#pragma once

#include <keeler/hill/elements.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace keeler::test {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "the twin needs more digits than what it tests");

class BernsteinTwin {
public:
  /// `hi` is displaced by the shift, exactly; `radius_sum` is the distance of contact.
  BernsteinTwin(const Elements& lo, const Elements& hi, double shift_x, double shift_y, Real radius_sum,
                const Frequencies& f)
      : radius_sum_(radius_sum), kappa_(f.kappa), nu_(f.nu), shear_((4 - kappa_ * kappa_) / 2),
        guiding_x_(sum(hi.guiding_x, shift_x, -lo.guiding_x)), guiding_y_(sum(hi.guiding_y, shift_y, -lo.guiding_y)),
        e_cos_(Real(hi.e_cos) - lo.e_cos), e_sin_(Real(hi.e_sin) - lo.e_sin), i_sin_(Real(hi.i_sin) - lo.i_sin),
        i_cos_(Real(hi.i_cos) - lo.i_cos), e_(std::hypot(e_cos_, e_sin_)), i_(std::hypot(i_sin_, i_cos_)) {}

  Real gap(Real t) const { return at(t).gap; }     ///< f
  Real slope(Real t) const { return at(t).slope; } ///< f′
  Real speed(Real t) const { return at(t).speed; } ///< |v|
  Real distance(Real t) const { return at(t).distance; }

  Real scale() const { ///< the largest of the lengths that make up the relative orbit
    return std::max({std::fabs(guiding_x_), std::fabs(guiding_y_), 2 * e_ / kappa_, i_});
  }
  Real largest_speed() const {
    return std::sqrt(square(kappa_ * e_) + square(2 * e_ + shear_ * std::fabs(guiding_x_)) + square(nu_ * i_));
  }

  /// Returns an upper bound on the depth of contact that the pair reaches, approaching, in [from, to], in units of
  /// `bound`: of f below 0, or of its decrease while in contact. The search ends if it exceeds 1.
  double sinks(Real from, Real to, Real bound) {
    bound_ = bound;
    deepest_ = fallen_ = 0;
    pieces_ = 0;
    if (to > from)
      walk(from, to);
    return static_cast<double>(std::max(deepest_, fallen_) / bound);
  }

  int pieces() const { return pieces_; } ///< of the last proof

private:
  static constexpr int order = 8, degree = 2 * order; // of the coordinates, of P
  static constexpr int max_pieces = 100000;
  static constexpr Real eps = std::numeric_limits<Real>::epsilon();
  using Coefficients = std::array<Real, degree + 1>;

  struct Point {
    Real gap, slope, speed, distance;
  };

  static Real square(Real x) { return x * x; }

  // a + b + c of doubles, the errors of both additions kept (Knuth 1969)
  static Real sum(Real a, Real b, Real c) {
    const Real s = a + b, bb = s - a, low_s = (a - (s - bb)) + (b - bb);
    const Real d = s + c, cc = d - s, low_d = (s - (d - cc)) + (c - cc);
    return d + (low_s + low_d);
  }

  // Rotates the eccentricity and inclination vectors to time t.
  struct Turned {
    Real ec, es, is, ic;
  };
  Turned turned(Real t) const {
    const Real ce = std::cos(kappa_ * t), se = std::sin(kappa_ * t);
    const Real ci = nu_ == kappa_ ? ce : std::cos(nu_ * t), si = nu_ == kappa_ ? se : std::sin(nu_ * t);
    return {e_cos_ * ce - e_sin_ * se, e_sin_ * ce + e_cos_ * se, i_sin_ * ci + i_cos_ * si, i_cos_ * ci - i_sin_ * si};
  }

  Point at(Real t) const {
    const Turned e = turned(t);
    const Real x = guiding_x_ - e.ec, y = guiding_y_ - shear_ * guiding_x_ * t + 2 / kappa_ * e.es, z = e.is;
    const Real vx = kappa_ * e.es, vy = 2 * e.ec - shear_ * guiding_x_, vz = nu_ * e.ic;
    const Real d2 = x * x + y * y + z * z;
    return {d2 - radius_sum_ * radius_sum_, 2 * (x * vx + y * vy + z * vz), std::sqrt(vx * vx + vy * vy + vz * vz),
            std::sqrt(d2)};
  }

  // Bernstein coefficients of uᵏ on [−1, 1]: that of index i is the mean product of k out of (degree − i) factors −1
  // and i factors +1. None exceeds 1, so the change of basis loses no digits.
  static const std::array<Coefficients, degree + 1>& basis() {
    static const std::array<Coefficients, degree + 1> table = [] {
      std::array<Coefficients, degree + 1> result;
      Coefficients binomial{};
      for (int i = 0; i <= degree; ++i) {
        Coefficients product{};
        product[0] = 1;
        for (int factor = 0; factor < degree; ++factor)
          for (int k = factor + 1; k > 0; --k)
            product[k] += factor < degree - i ? -product[k - 1] : product[k - 1];
        if (i == 0)
          for (int k = 0; k <= degree; ++k)
            binomial[k] = std::fabs(product[k]);
        for (int k = 0; k <= degree; ++k)
          result[k][i] = product[k] / binomial[k];
      }
      return result;
    }();
    return table;
  }

  // P in powers of u on a piece, and bounds on |f − P| and on 2 |f′ − P′| as computed (the width in u is 2): remainder
  // and rounding. The second shrinks with the piece, so that many short pieces add up to no more than a long one.
  struct Piece {
    Coefficients power{};
    Real error, fall_error;
  };

  Piece piece(Real centre, Real width) const {
    std::array<Real, order + 1> x, y, z;
    const Turned turn = turned(centre);
    Real e_term = 1, i_term = 1, size = 0, change = 0; // (κw)ⁿ/n!, (νw)ⁿ/n!; Σ |coefficients| from n = 0, from n = 1
    for (int n = 0; n <= order; ++n) {
      const Real sign = n % 4 < 2 ? 1 : -1;
      const bool even = n % 2 == 0;
      x[n] = -sign * e_term * (even ? turn.ec : -turn.es);
      y[n] = sign * 2 / kappa_ * e_term * (even ? turn.es : turn.ec);
      z[n] = sign * i_term * (even ? turn.is : turn.ic);
      e_term *= kappa_ * width / (n + 1);
      i_term *= nu_ * width / (n + 1);
    }
    x[0] += guiding_x_;
    y[0] += guiding_y_ - shear_ * guiding_x_ * centre;
    y[1] -= shear_ * guiding_x_ * width;
    Piece result;
    for (int n = 0; n <= order; ++n) {
      const Real term = std::fabs(x[n]) + std::fabs(y[n]) + std::fabs(z[n]);
      size += term;
      change += n > 0 ? term : 0;
      for (int m = 0; m <= order; ++m)
        result.power[n + m] += x[n] * x[m] + y[n] * y[m] + z[n] * z[m];
    }
    result.power[0] -= radius_sum_ * radius_sum_;
    const Real remainder = std::hypot(e_ * e_term * std::hypot(Real(1), 2 / kappa_), i_ * i_term);
    const Real lengths =
        std::fabs(guiding_x_) * (1 + shear_ * std::fabs(centre)) + std::fabs(guiding_y_) + (1 + 2 / kappa_) * e_ + i_;
    // 44 additions at most in a coefficient of P; 8 roundings in one of a coordinate
    result.error = remainder * (2 * size + remainder) +
                   eps * (24 * (size * size + radius_sum_ * radius_sum_) + 16 * size * lengths);
    const Real path = width * std::max({kappa_, nu_, shear_}) * lengths;
    result.fall_error = 4 * remainder * (change + (order + 1) * (size + remainder)) +
                        eps * (96 * degree * size * change + 64 * (lengths * change + size * path));
    return result;
  }

  // A lower bound of P from the Bernstein coefficients b of P less its constant; `fall` bounds how far P falls anywhere
  // below where it was.
  struct Low {
    Real least, fall;
    bool reached; // by an approach: P falls throughout, or falls and rises
  };

  static Low bound_below(const Coefficients& b, const Coefficients& power) {
    Real least = b[0], low_first = HUGE_VALL, high_first = -HUGE_VALL, low_second = HUGE_VALL, high_second = -HUGE_VALL;
    for (int i = 1; i <= degree; ++i) {
      least = std::min(least, b[i]);
      low_first = std::min(low_first, b[i] - b[i - 1]);
      high_first = std::max(high_first, b[i] - b[i - 1]);
      if (i > 1) {
        low_second = std::min(low_second, b[i] - 2 * b[i - 1] + b[i - 2]);
        high_second = std::max(high_second, b[i] - 2 * b[i - 1] + b[i - 2]);
      }
    }
    // P′ >= degree × low_first / 2 in u, over a width of 2
    const Real fall = degree * std::max<Real>(0, -low_first);
    if (high_first <= 0 || low_first >= 0 || high_second <= 0)
      least = std::min(b[0], b[degree]);
    else if (low_second >= 0)
      least = std::max(least, lowest_tangent(power) - power[0]);
    return {least + power[0], fall, high_first <= 0 || (low_second >= 0 && b[1] < b[0])};
  }

  // Returns the minimum on [−1, 1] of a tangent to P near its minimum: a lower bound of P where it is convex.
  static Real lowest_tangent(const Coefficients& power) {
    Real best = -HUGE_VALL, u = 0, left = -1, right = 1;
    for (int pass = 0; pass < 12; ++pass) {
      Real value = 0, first = 0, second = 0; // P, P′, P″/2 by Horner's rule
      for (int k = degree; k >= 0; --k) {
        second = second * u + first;
        first = first * u + value;
        value = value * u + power[k];
      }
      const Real lowest = first > 0 ? value - first * (1 + u) : value + first * (1 - u);
      best = std::max(best, lowest);
      (first > 0 ? right : left) = u;
      const Real next = u - first / (2 * second);
      if (next == u)
        break;
      u = next > left && next < right ? next : (left + right) / 2;
    }
    return best;
  }

  void walk(Real from, Real to) {
    const Real centre = (from + to) / 2, width = (to - from) / 2;
    if (++pieces_ > max_pieces)
      deepest_ = HUGE_VALL;
    if (std::max(deepest_, fallen_) > bound_)
      return; // convicted
    if (distance(centre) - largest_speed() * width > radius_sum_ * (1 + Real(1e-12)))
      return;
    const Piece p = piece(centre, width);
    Coefficients b{};
    for (int k = 1; k <= degree; ++k)
      for (int i = 0; i <= degree; ++i)
        b[i] += p.power[k] * basis()[k][i];
    const Low low = bound_below(b, p.power);
    if (low.least - p.error >= 0)
      return;
    if (const Real fall = low.fall + p.fall_error; 64 * fall <= bound_) { // in contact, but no deeper than allowed
      fallen_ += fall;
      return;
    }
    // deeper than half: the decrease decides, as the pair may just have left contact and turned back
    if (64 * p.error <= bound_ && low.least - p.error >= -bound_ * (low.reached ? 9.0L / 16 : 1.0L / 64)) {
      deepest_ = std::max(deepest_, p.error - low.least);
      return;
    }
    if (width <= 4 * eps * (1 + std::fabs(centre))) { // nothing is left to halve
      deepest_ = std::max(deepest_, p.error - low.least);
      return;
    }
    walk(from, centre);
    walk(centre, to);
  }

  Real radius_sum_, kappa_, nu_, shear_;
  Real guiding_x_, guiding_y_, e_cos_, e_sin_, i_sin_, i_cos_, e_, i_;
  Real bound_ = 0, deepest_ = 0, fallen_ = 0;
  int pieces_ = 0;
};

} // namespace keeler::test
