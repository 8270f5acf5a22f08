// Bounds on rounding errors of a pair's f = |d|² − R² and of f′ near contact.
//
// δ is the finder's allowance for f as evaluated (gap_error in motion/relative.hpp) at |d| = R, with 2R c for the
// rounding c of the coordinates of an image, which precedes all motion. The search may let f decrease by δ beyond
// an evaluation with an error of δ, and by one more δ per 1024 passes: 2 δ (1 + passes/1024). Rounding of the time adds
// f′ times half its spacing.
#pragma once

#include "unit/finders/bernstein_twin.hpp"
#include "unit/finders/random_pairs.hpp"

#include <limits>

namespace keeler::test {

inline constexpr Real unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

struct Allowance {
  Real gap, closing, image;

  Allowance(const PairCase& c, const BernsteinTwin& twin, Real radius_sum) {
    const Elements& hi = c.bodies[1].elements;
    const bool shifted = c.query.shift_x != 0.0 || c.query.shift_y != 0.0;
    const Real x = hi.guiding_x + c.query.shift_x, y = hi.guiding_y + c.query.shift_y, s = c.frequencies.shear();
    image = shifted ? unit_roundoff * (std::fabs(x) * (1 + s * c.end) + std::fabs(y)) : 0;
    const Real image_speed = shifted ? unit_roundoff * s * std::fabs(x) : 0;
    gap = gap_error(radius_sum, radius_sum, twin) + 2 * radius_sum * image;
    closing = closing_error(radius_sum, twin.largest_speed(), twin) +
              2 * (radius_sum * image_speed + twin.largest_speed() * image);
  }

  static Real gap_error(Real distance, Real radius_sum, const BernsteinTwin& twin) {
    return 8 * unit_roundoff * (distance * distance + radius_sum * radius_sum + 4 * distance * twin.scale());
  }
  static Real closing_error(Real distance, Real speed, const BernsteinTwin& twin) {
    return 64 * unit_roundoff * (distance * speed + distance * twin.largest_speed() + speed * twin.scale());
  }
};

} // namespace keeler::test
