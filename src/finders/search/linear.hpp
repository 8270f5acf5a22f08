// Search, form "linear" (the paper's fastest): the next guess is the contact of straight lines from the current guess,
// or else their closest approach; the move is halved while |f| grows or the particles recede there.
//
// It can miss a contact, most often because the form "full" ends at a closest approach with d² > 2 R², although
// straight lines from there may lead to a contact. The test uses the distance
// reached by the move. Of random pairs that touch within a step of 0.1 orbit at relative speeds of about 1, 3 and 10 rΩ
// this form loses 0.4, 0.4 and 9.5 %, like the published code (up to 11 %). Tested on the distance before the move, it
// would lose 2.5, 17 and 45 %; without the test, 0.4, 0.01 and 0 %.
#pragma once

#include <keeler/finders/finder.hpp>
#include <keeler/finders/search/published.hpp>

namespace keeler::finders {

/// The published code differs slightly between the two motions with this search.
enum class LinearForm { full, cubic };

template<LinearForm form> struct LinearSearch {
  template<class Motion> static FinderResult find(Motion& motion, const Pair& pair);

private:
  static double overlap_delay(const Separation& now, const Pair& pair);
};

template<LinearForm form> double LinearSearch<form>::overlap_delay(const Separation& now, const Pair& pair) {
  if (form == LinearForm::full && pair.start > pair.end - pair.step)
    return Published::overlap_radius * pair.smaller / now.v.norm();
  return Published::overlap_step * pair.step;
}

template<LinearForm form>
template<class Motion>
FinderResult LinearSearch<form>::find(Motion& motion, const Pair& pair) {
  using P = Published;
  const double radius_sum2 = pair.radius_sum * pair.radius_sum;
  FinderResult result;
  Separation now = first_separation(motion, pair, result);
  if (!is_number(now))
    return not_a_number(result);
  if (now.closing() >= 0.0)
    return leave(result, PublishedExit::receding);
  if (now.d.squaredNorm() <= radius_sum2 * (1.0 + P::convergence))
    return overlap(result, pair, overlap_delay(now, pair));

  double guess = pair.start;
  int closest_moves = 0;
  while (result.iterations < P::iterations) {
    ++result.iterations;
    const double gap = now.gap(pair.radius_sum), v2 = now.v.squaredNorm(), dv = now.d.dot(now.v);
    const double discriminant = dv * dv - v2 * gap;
    const bool touches = discriminant >= 0.0;
    double move = (-dv - (touches ? std::sqrt(discriminant) : 0.0)) / v2;
    if (!touches && ++closest_moves > P::closest_moves)
      return leave(result, PublishedExit::closest_moves);
    if (!touches && std::fabs(move) < P::min_move * pair.step)
      return leave(result, PublishedExit::no_movement);
    if (leads_nowhere(move, pair))
      return leave(result, move > 0.0 ? PublishedExit::too_late : PublishedExit::too_early);

    now = motion.at(guess + move);
    ++result.evaluations;
    const auto worse = [&](const Separation& s) {
      return std::fabs(s.gap(pair.radius_sum)) > std::fabs(gap) || s.closing() > 0.0;
    };
    if (!damp(motion, guess, move, now, result, worse))
      return leave(result, PublishedExit::halvings);
    if (!is_number(now))
      return not_a_number(result);
    guess += move;
    if (out_of_range(guess, pair, result))
      return result;
    if (is_root(now, pair.radius_sum) && now.closing() < 0.0) {
      result.time = guess;
      return leave(result, PublishedExit::root);
    }
    if (form == LinearForm::full && !touches && now.d.squaredNorm() > P::hopeless * radius_sum2)
      return leave(result, PublishedExit::no_movement);
  }
  return leave(result, PublishedExit::iterations);
}

} // namespace keeler::finders
