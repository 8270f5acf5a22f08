#include "step_control.hpp"

#include <keeler/core/field_table.hpp>
#include <keeler/scene/scene.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::simulation {
namespace {

constexpr std::uint64_t enough = 500; // contacts needed for a decision
// In the wakes of the A ring 12 % of contacts are unresolved at kicks 16/1000 of an orbit apart, and 2.7 % at 8/1000.
// The viscosity of a dense patch errs by 0.4 % at 28 %, and by 1.8 % at 42 % (docs/dev/step.md).
constexpr double most_unresolved = 0.08, few_unresolved = 0.02;
constexpr double max_contacts = 0.5, few_contacts = 0.25; // per particle and drift

std::int64_t kick_for(std::int64_t kick, double unresolved) {
  if (unresolved > most_unresolved)
    return std::max<std::int64_t>(1, kick / 2);
  return unresolved < few_unresolved ? std::min(scene::TimeSettings::longest, 2 * kick) : kick;
}

// `rate`: contacts per particle and tick.
std::int64_t step_for(std::int64_t step, double rate) {
  while (step > 1 && rate * static_cast<double>(step) > max_contacts)
    step /= 2;
  while (step < scene::TimeSettings::longest && rate * static_cast<double>(2 * step) <= few_contacts)
    step *= 2;
  return step;
}

} // namespace

StepControl StepControl::automatic(bool with_forces) {
  return {.step = 4, .kick = with_forces ? 16 : scene::TimeSettings::longest};
}

StepControl decide_step(const StepControl& last, const CollisionTally& tally, std::size_t particles,
                        std::int64_t tick) {
  StepControl next = last;
  next.decided_at = tick;
  next.contacts = tally.fast + tally.slow;
  next.unresolved = tally.unresolved;
  assert(tick >= last.decided_at && next.contacts >= last.contacts && next.unresolved >= last.unresolved);
  const std::uint64_t contacts = next.contacts - last.contacts;
  if (contacts >= enough)
    next.kick =
        kick_for(last.kick, static_cast<double>(next.unresolved - last.unresolved) / static_cast<double>(contacts));
  const double passed = static_cast<double>(particles) * static_cast<double>(tick - last.decided_at);
  if (passed > 0.0)
    next.step = step_for(last.step, 2.0 * static_cast<double>(contacts) / passed);
  next.step = std::min(next.step, next.kick);
  return next;
}

void StepControl::list_fields(FieldTable& table) {
  table.scalar("step_ticks", step, "1", "ticks in a step");
  table.scalar("kick_ticks", kick, "1", "ticks from kick to kick; 0: as the scene says");
  table.scalar("steps", steps, "1", "steps done");
  table.scalar("decided_at", decided_at, "1", "tick of the last decision on these");
  table.scalar("decided_contacts", contacts, "1", "contacts counted by then");
  table.scalar("decided_unresolved", unresolved, "1", "of these, unresolved ones");
}

} // namespace keeler::simulation
