// A fingerprint of what a run has become: two runs with the same hash are the same run, however they got there.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/state.hpp>

#include <string>

namespace keeler {

/// 32 hexadecimal digits over, in the order of the ids, the particles' elements, radii and masses, the step number and
/// length, the box with its shear offset, the seed, and the scene's keys that change the physics. Not over end time,
/// schedules, threads, memory order, counters or provenance. Collective: of the particles of all ranks, on all.
std::string state_hash(const SimulationState& state, const Scene& scene, const Communicator& ranks = {});

} // namespace keeler
