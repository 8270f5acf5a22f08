// Motion, form "full": each particle on its epicycle, with its own sines and cosines at each guess, as timed in the
// paper: eight values per evaluation, even if κ = ν would make two angles equal.
// StoredStartMotion is this path with the states at the step's start stored per particle: a pair that recedes there
// needs no sine or cosine.
#pragma once

#include <keeler/finders/finder.hpp>

#include <optional>

namespace keeler::finders {

/// Returns a rotation computed from scratch: two sines and two cosines.
inline Rotation own_rotation(const Frequencies& f, double time) {
  Rotation r;
  r.after = time;
  hill::sine_cosine(f.kappa * time, r.sin_e, r.cos_e);
  hill::sine_cosine(f.nu * time, r.sin_i, r.cos_i);
  return r;
}

class FullMotion {
public:
  FullMotion(const Pair& pair, const DriftStep& step) : pair_(pair), frequencies_(step.frequencies) {}

  Separation at(double time) const {
    const State lo = state_at(pair_.lo, frequencies_, own_rotation(frequencies_, time));
    const State hi = state_at(pair_.hi, frequencies_, own_rotation(frequencies_, time));
    return {hi.position - lo.position, hi.velocity - lo.velocity};
  }

protected:
  const Pair& pair_;
  const Frequencies& frequencies_;
};

class StoredStartMotion : public FullMotion {
public:
  using Memory = State; // at the step's start

  static Memory remember(const Elements& el, const DriftStep& step) {
    return state_at(el, step.frequencies, step.at_begin);
  }

  StoredStartMotion(const Pair& pair, const DriftStep& step, const Memory& lo, const Memory& hi)
      : FullMotion(pair, step), lo_(lo), hi_(hi), begin_(step.begin) {}

  /// Returns nothing later in the step, when particles have been moved to other times.
  std::optional<Separation> at_start() const {
    if (pair_.start != begin_)
      return std::nullopt;
    const State image = image_offset(pair_, frequencies_, begin_);
    return Separation{hi_.position - lo_.position + image.position, hi_.velocity - lo_.velocity + image.velocity};
  }

private:
  const Memory &lo_, &hi_;
  double begin_;
};

} // namespace keeler::finders
