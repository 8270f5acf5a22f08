#include "rebuild_policy.hpp"

#include "ablation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace keeler::collision {

void RebuildPolicy::begin_step(bool undisturbed) {
  if (!undisturbed)
    last_undisturbed_ = std::exchange(undisturbed_, -1) + 1;
  ++undisturbed_;
}

int RebuildPolicy::choose_lifetime(bool valid, const StepInterval& lists, double step) {
  assert(step > 0.0);
  constexpr double max_time = 1.0; // rad: bounds and rounding are good for that long
  constexpr int max_steps = 64;
  if (valid && lists.age > 0) {
    const double cost = cost_ / lists.age;
    if (last_cost_ > 0.0 && cost > last_cost_)
      growth_ = growth_ > 1.0 ? 0.8 : 1.25;
    last_cost_ = cost;
    const int next = static_cast<int>(std::lround(growth_ * std::min(lists.age, lists.length)));
    lifetime_ = std::max(1, growth_ > 1.0 ? std::max(next, lists.age + 1) : next);
  }
  lifetime_ = std::clamp(static_cast<int>(max_time / step), 1, std::min(max_steps, lifetime_));
  if (without(Acceleration::lists))
    lifetime_ = 1;
  return lifetime_;
}

int RebuildPolicy::halve_lifetime() {
  assert(lifetime_ > 1);
  return lifetime_ /= 2;
}

int RebuildPolicy::pruning_interval(std::size_t dirty, std::size_t particles, int steps, const StepInterval& lists,
                                    double step) const {
  assert(step > 0.0 && !lists.over());
  constexpr double max_time = 0.2; // rad: paths are still nearly straight
  constexpr int max_steps = 8;
  constexpr double max_dirty = 0.1; // of all particles: each later step goes through their whole lists
  const double dirty_steps = static_cast<double>(dirty) + 1e-3,
               particle_steps = static_cast<double>(particles) * std::max(1, steps);
  const int to_disturbance = last_undisturbed_ > undisturbed_ ? last_undisturbed_ - undisturbed_ : max_steps;
  const int nearly_straight = std::clamp(static_cast<int>(max_time / step), 1, max_steps);
  const int calm = static_cast<int>(std::min<double>(max_steps, max_dirty * particle_steps / dirty_steps));
  return std::clamp(std::min({nearly_straight, to_disturbance, lists.rest(), calm}), 1, max_steps);
}

bool RebuildPolicy::better_rebuild_all(std::size_t escaped, std::size_t particles) const {
  constexpr std::size_t cost = 6; // of one list by itself, in lists of a rebuild of all
  return (without(Acceleration::mending) && escaped > 0) || (renewed_ + escaped) * cost > particles;
}

void RebuildPolicy::rebuilt_all(std::size_t particles, std::uint64_t tests, std::uint64_t entries) {
  cost_ = 60.0 * static_cast<double>(particles) + 1.3 * static_cast<double>(tests);
  cost_ += 6.0 * static_cast<double>(entries);
  renewed_ = 0;
}

void RebuildPolicy::updated(std::size_t escaped) {
  cost_ += 800.0 * static_cast<double>(escaped);
}

void RebuildPolicy::pruned(std::uint64_t pairs) {
  cost_ += 2.0 * static_cast<double>(pairs);
}

void RebuildPolicy::hit(std::uint64_t entries_of_dirty) {
  cost_ += 5.0 * static_cast<double>(entries_of_dirty);
}

} // namespace keeler::collision
