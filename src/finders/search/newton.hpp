// Search, form "Newton": follows f = |d|² − R² along its tangent, in three forms of the published code:
//   original   steps of half length, halved again while |f| grows
//   damped     full steps, halved while |f| grows or the particles recede: the paper's method
//   as_coded   damped, but the first trial of each step is evaluated at the begin of the step, not at its end. It is
//              hardly ever worse there, so steps are hardly ever damped. The code was published in this form.
// As in that code, all three evaluate the accepted guess once more: it is part of the time that the paper measured.
// Only the original checks whether the particles approach at the root.
#pragma once

#include <keeler/finders/finder.hpp>
#include <keeler/finders/search/published.hpp>

namespace keeler::finders {

enum class NewtonForm { original, damped, as_coded };

template<NewtonForm form> struct NewtonSearch {
  template<class Motion> static FinderResult find(Motion& motion, const Pair& pair);

private:
  template<class Motion>
  static bool step(Motion& motion, const Pair& pair, double& guess, Separation& now, FinderResult& result);
  template<class Motion>
  static bool back_to_approach(Motion& motion, const Pair& pair, double& guess, Separation& now, FinderResult& result);
};

template<NewtonForm form>
template<class Motion>
FinderResult NewtonSearch<form>::find(Motion& motion, const Pair& pair) {
  FinderResult result;
  Separation now = first_separation(motion, pair, result);
  if (!is_number(now))
    return not_a_number(result);
  if (now.closing() >= 0.0)
    return leave(result, PublishedExit::receding);
  if (now.gap(pair.radius_sum) < 0.0)
    return overlap(result, pair, Published::overlap_step * pair.step);

  double guess = pair.start;
  for (; result.iterations < Published::iterations; ++result.iterations) {
    if (is_root(now, pair.radius_sum)) {
      const bool behind = form == NewtonForm::original && now.closing() > 0.0 && guess > pair.end - pair.step;
      if (!behind) {
        result.time = guess;
        return leave(result, PublishedExit::root);
      }
      if (!back_to_approach(motion, pair, guess, now, result))
        return leave(result, PublishedExit::iterations);
    }
    if (!step(motion, pair, guess, now, result)) {
      ++result.iterations;
      return result;
    }
  }
  return leave(result, PublishedExit::iterations);
}

/// Makes one pass; false if it ends the search.
template<NewtonForm form>
template<class Motion>
bool NewtonSearch<form>::step(Motion& motion, const Pair& pair, double& guess, Separation& now, FinderResult& result) {
  const double gap = now.gap(pair.radius_sum);
  double step = -(form == NewtonForm::original ? 0.5 : 1.0) * gap / now.closing();
  if (leads_nowhere(step, pair)) {
    leave(result, step > 0.0 ? PublishedExit::too_late : PublishedExit::too_early);
    return false;
  }
  Separation trial = motion.at(form == NewtonForm::as_coded ? guess : guess + step);
  ++result.evaluations;
  const auto worse = [&](const Separation& s) {
    return std::fabs(s.gap(pair.radius_sum)) > std::fabs(gap) || (form != NewtonForm::original && s.closing() > 0.0);
  };
  if (!damp(motion, guess, step, trial, result, worse)) {
    leave(result, PublishedExit::halvings);
    return false;
  }
  guess += step;
  now = motion.at(guess);
  ++result.evaluations;
  if (!is_number(now)) {
    not_a_number(result);
    return false;
  }
  return !out_of_range(guess, pair, result);
}

/// Moves from a root where the particles recede, by halves towards the start of the span, to where they still approach.
template<NewtonForm form>
template<class Motion>
bool NewtonSearch<form>::back_to_approach(Motion& motion, const Pair& pair, double& guess, Separation& now,
                                          FinderResult& result) {
  constexpr int max_halvings = 64; // the guess no longer moves
  for (int k = 0; k < max_halvings && now.closing() > 0.0; ++k) {
    guess = 0.5 * (guess + pair.start);
    now = motion.at(guess);
    ++result.evaluations;
  }
  return !(now.closing() > 0.0);
}

} // namespace keeler::finders
