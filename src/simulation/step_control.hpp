// The automatic step: chooses the lengths of drifts and kick intervals from the state of the run.
//
// A long kick interval errs at contacts: a kick presses touching particles together by g Δt, with g the pair's gravity,
// and contacts slower than that are not resolved (contact_law.hpp in collision). Their fraction of all contacts
// measures the error of the kick interval. Drifts are exact for any length; the number of contacts per particle and
// drift decides which is cheapest. The run counts both, so the choice is bit-identical for any number of threads and
// after a restart.
#pragma once

#include <keeler/simulation/state.hpp>

#include <cstdint>

namespace keeler::simulation {

/// Ticks between two decisions: a sixteenth of an orbit.
inline constexpr std::int64_t decision_ticks = 256;

/// Returns the next lengths, from the contacts counted since the last decision. Precondition: `tick` is a multiple of
/// decision_ticks.
StepControl decide_step(const StepControl& last, const CollisionTally& tally, std::size_t particles, std::int64_t tick);

} // namespace keeler::simulation
