// What no patch of a ring has, in a state that somebody else made or changed: the ranges of the scene's keys hold for
// it too. Beyond them steps and searches may not end.
#pragma once

#include <keeler/hill/elements.hpp>
#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler {

/// "a radius (m) of -1 (possible is from 1e-6 to 1000000)"; empty when particle k is possible. The patch knows its
/// orbital frequency.
std::string particle_fault(const Patch& patch, std::size_t k);

/// "x = 2000, y = 3 outside the box of 60 m x 60 m about 0 (as has its guiding centre)"; empty when a particle of a
/// start with this state (m, m rad⁻¹) is in the box or close to it.
std::string box_fault(const State& state, const ShearingBox& box, const Frequencies& frequencies);

/// Throws InvariantError that names what is not possible in the patch of this file: the planet, the box or a particle.
/// UsageError when it has none.
void require_possible(const Patch& patch, const std::string& path);
/// The same of a patch of so many particles but for them, and of the particles.
void require_possible_frame(const Patch& patch, std::size_t count, const std::string& path);
void require_possible_particles(const Patch& patch, const std::string& path);

} // namespace keeler
