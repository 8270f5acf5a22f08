// Validation of states made or changed outside Keeler, against the ranges of the scene's keys. Beyond them steps and
// searches may not end.
#pragma once

#include <keeler/hill/elements.hpp>
#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler::initial_conditions {

/// Returns a description such as "a radius (m) of -1 (possible is from 1e-6 to 1000000)", or an empty string if
/// particle k is valid. Precondition: the patch has its orbital frequency.
std::string particle_fault(const Patch& patch, std::size_t k);

/// Returns a description such as "x = 2000, y = 3 outside the box of 60 m x 60 m about 0 (as has its guiding centre)",
/// or an empty string if a particle with this state (m, m rad⁻¹) is in the box or close to it.
std::string box_fault(const State& state, const ShearingBox& box, const Frequencies& frequencies);

/// Throws InvariantError that names the invalid value of this file: of the planet, the box or a particle. Throws
/// UsageError if the patch is empty.
void require_possible(const Patch& patch, const std::string& path);
/// The two parts of this check: all but the particles of a patch with `count` of them, and the particles.
void require_possible_frame(const Patch& patch, std::size_t count, const std::string& path);
void require_possible_particles(const Patch& patch, const std::string& path);

} // namespace keeler::initial_conditions
