// What no particle of a ring has, in a state that somebody else made: the ranges of the scene's keys hold for it too.
#pragma once

#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler {

/// "a radius (m) of -1 (possible is from 1e-6 to 1000000)"; empty when particle k is possible. The patch knows its
/// orbital frequency.
std::string particle_fault(const Patch& patch, std::size_t k);

} // namespace keeler
