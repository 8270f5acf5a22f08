// The automatic step: chooses the lengths of drifts and kick intervals from the state of the run.
//
// A long kick interval errs at contacts: touching particles get a closing speed g Δt from it, with g the pair's
// gravity, and the kick itself makes the contacts slower than that. Their fraction of all contacts measures the error
// of the kick interval. Drifts are exact for any length; the number of contacts per particle and drift decides which is
// cheapest. The run counts both, so the choice is bit-identical for any number of threads and after a restart.
#pragma once

#include <keeler/collision/drift.hpp>

#include <cstdint>

namespace keeler {

/// Lengths in ticks, powers of two. A step never crosses a multiple of its length, nor of the kick interval.
struct StepControl {
  std::int64_t step = 1;
  std::int64_t kick = 0;  ///< interval of all forces; 0: set by the scene for each force
  std::int64_t steps = 0; ///< done since the run began

  // tally at the last decision
  std::int64_t decided_at = 0; ///< tick
  std::uint64_t contacts = 0, unresolved = 0;

  /// True if a step may begin at that tick.
  bool fits(std::int64_t tick) const { return tick % step == 0 && (kick == 0 || kick % step == 0); }

  /// Returns the first lengths of an automatic step.
  static StepControl automatic(bool with_forces);

  void list_fields(FieldTable& table);
};

/// Ticks between two decisions: a sixteenth of an orbit.
inline constexpr std::int64_t decision_ticks = 256;

/// Returns the next lengths, from the contacts counted since the last decision. Precondition: `tick` is a multiple of
/// decision_ticks.
StepControl decide_step(const StepControl& last, const CollisionTally& tally, std::size_t particles, std::int64_t tick);

} // namespace keeler
