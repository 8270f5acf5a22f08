// A fingerprint of a run's state: runs with equal hashes have bitwise equal states, whatever their restarts, threads
// and ranks.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/state.hpp>

#include <string>

namespace keeler::runs {

/// Returns a hash of 32 hexadecimal digits over the particles' elements, radii and masses (in the order of their ids),
/// the step number and length, the box with its shear offset, the seed, and the scene's keys that change the physics;
/// not over end time, schedules, threads, memory order, counters or provenance. Collective: every rank gets the hash of
/// the particles of all ranks.
std::string state_hash(const simulation::SimulationState& state, const Scene& scene, const Communicator& ranks = {});

} // namespace keeler::runs
