// What no patch of a ring has, in a state that somebody else made or changed: the ranges of the scene's keys hold for
// it too. Beyond them steps and searches may not end.
#pragma once

#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler {

/// "a radius (m) of -1 (possible is from 1e-6 to 1000000)"; empty when particle k is possible. The patch knows its
/// orbital frequency.
std::string particle_fault(const Patch& patch, std::size_t k);

/// Throws InvariantError that names what is not possible in the patch of this file: the planet, the box or a particle.
/// UsageError when it has none.
void require_possible(const Patch& patch, const std::string& path);
/// The same of a patch of so many particles but for them, and of the particles.
void require_possible_frame(const Patch& patch, std::size_t count, const std::string& path);
void require_possible_particles(const Patch& patch, const std::string& path);

} // namespace keeler
