// Motion, form "full": each particle on its own epicycle, with its own sines and cosines at each guess, as the paper
// timed it.
#pragma once

#include <keeler/collision/finder.hpp>

namespace keeler {

class FullMotion {
public:
  FullMotion(const Pair& pair, const DriftStep& step) : pair_(pair), frequencies_(step.frequencies) {}

  Separation at(double time) const {
    const State lo = state_at(pair_.lo, frequencies_, Rotation(frequencies_, time));
    const State hi = state_at(pair_.hi, frequencies_, Rotation(frequencies_, time));
    return {hi.position - lo.position, hi.velocity - lo.velocity};
  }

private:
  const Pair& pair_;
  const Frequencies& frequencies_;
};

} // namespace keeler
