// The automatic step: how long drifts and kick intervals are, by what the state itself tells.
//
// A kick that is long beside what it moves errs: particles that touch get a closing speed g Δt from it, with g the pull
// of the pair's own gravity, and contacts slower than that are made by the kick. Their share of all contacts is the
// measure of the kick interval. Drifts are exact for any length; the contacts that a particle has in one decide what is
// cheapest. Both are counted by the run, so the choice has the same bits for any number of threads, and a restart goes
// on with it.
#pragma once

#include <keeler/collision/drift.hpp>

#include <cstdint>

namespace keeler {

/// Lengths in ticks, powers of two. A step never crosses a multiple of its own length, nor of the kick interval.
struct StepControl {
  std::int64_t step = 1;
  std::int64_t kick = 0;  ///< interval of all forces; 0: as the scene says for each
  std::int64_t steps = 0; ///< done since the run began

  // what the tally said when this was decided
  std::int64_t decided_at = 0; ///< tick
  std::uint64_t contacts = 0, unresolved = 0;

  /// Whether a step may begin at that tick.
  bool fits(std::int64_t tick) const { return tick % step == 0 && (kick == 0 || kick % step == 0); }

  /// What an automatic step begins with.
  static StepControl automatic(bool with_forces);

  void list_fields(FieldTable& table);
};

/// Ticks from one decision to the next: a sixteenth of an orbit.
inline constexpr std::int64_t decision_ticks = 256;

/// The lengths for what comes, at a tick that is a multiple of decision_ticks, from what was counted since the last
/// decision.
StepControl decide_step(const StepControl& last, const CollisionTally& tally, std::size_t particles, std::int64_t tick);

} // namespace keeler
