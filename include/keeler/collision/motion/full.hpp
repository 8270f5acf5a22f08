// Motion, form "full": each particle on its own epicycle, with its own sines and cosines at each guess, as the paper
// timed it.
#pragma once

#include <keeler/collision/pair.hpp>

namespace keeler {

class FullMotion {
public:
  FullMotion(const Pair& pair, const Frequencies& f) : lo_(pair.lo), hi_(pair.hi), frequencies_(f) {}

  Separation at(double time) const {
    const State lo = state_at(lo_, frequencies_, Rotation(frequencies_, time));
    const State hi = state_at(hi_, frequencies_, Rotation(frequencies_, time));
    return {hi.position - lo.position, hi.velocity - lo.velocity};
  }

private:
  Elements lo_, hi_;
  Frequencies frequencies_;
};

} // namespace keeler
