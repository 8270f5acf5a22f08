// The finder "certified": finds the first contact on the relative epicycle, guaranteed. Pairs that provably approach up
// to their first root are solved by Newton's method, several at once; all others by CertifiedSearch.
#pragma once

#include <keeler/core/simd.hpp>
#include <keeler/finders/finder.hpp>

#include <memory>

namespace keeler::finders {

/// Results are bit-identical for all instruction sets. If Newton's method leaves a search undecided, its evaluations
/// are counted, but only the iterations of CertifiedSearch.
std::unique_ptr<Finder> make_certified_finder(InstructionSet set);

} // namespace keeler::finders
