// The finder "certified": the first contact on the relative epicycle, guaranteed. Pairs that provably approach all the
// way to their first root are found by Newton's method, several at once; all others by CertifiedSearch.
#pragma once

#include <keeler/core/simd.hpp>
#include <keeler/finders/finder.hpp>

#include <memory>

namespace keeler {

/// The instruction set has no say in any bit of the results. A search that Newton's method leaves undecided counts its
/// evaluations too, but only the passes of CertifiedSearch.
std::unique_ptr<Finder> make_certified_finder(InstructionSet set);

} // namespace keeler
