// Input and result of a finder: when do two particles first touch, approaching, within a span of one step?
#pragma once

#include <keeler/hill/elements.hpp>

namespace keeler::finders {

/// Two particles within one drift. `lo` has the lower id; the image offset has been added to `hi`. Times are relative
/// to the epoch of the elements, rad. The span is half-open: a contact at `end` belongs to the next step.
struct Pair {
  Elements lo, hi;
  double shift_x = 0.0, shift_y = 0.0; ///< added to X and Y of `hi`, at the epoch
  double radius_sum = 0.0;             ///< r_i + r_j, m
  double smaller = 0.0;                ///< the smaller of the two radii, m
  double start = 0.0; ///< the later of the two particles' last velocity changes in this step, or the step's start
  double end = 0.0;   ///< the end of the step
  double step = 0.0;  ///< the length of the whole step
};

/// Relative position and velocity, hi − lo.
struct Separation {
  Vec3 d = Vec3::Zero(); ///< m
  Vec3 v = Vec3::Zero(); ///< m rad^-1

  double gap(double radius_sum) const { return d.squaredNorm() - radius_sum * radius_sum; } ///< f = |d|² − R²
  double closing() const { return 2.0 * d.dot(v); }                                         ///< f′
};

/// Why a finder returned.
enum class FinderExit {
  hit,         ///< first contact found
  overlapping, ///< in contact and approaching at the start: the event is now
  receding,    ///< moving apart at the start (and, for a certified finder, for the whole span)
  missed,      ///< no contact in the span
  outside,     ///< a root was found, but before the start or after the end of the span
  gave_up,     ///< the iteration did not converge; a contact may have been lost
  not_a_number ///< the elements are not finite
};
inline constexpr int finder_exits = 7;

/// Returns the exit's name, as in reports and JSON.
const char* name_of(FinderExit exit);

struct FinderResult {
  FinderExit exit = FinderExit::missed;
  double time = 0.0;   ///< of the contact, in [start, end), if exit is hit or overlapping
  int iterations = 0;  ///< passes of the search loop
  int evaluations = 0; ///< evaluations of the motion
  int halvings = 0;    ///< trial steps that were halved; each is an evaluation too

  bool contact() const { return exit == FinderExit::hit || exit == FinderExit::overlapping; }
};

} // namespace keeler::finders
