// What bench drift and bench step print alike.
#pragma once

#include <keeler/bench/timed_steps.hpp>

#include <nlohmann/json.hpp>

namespace keeler {

/// Counts of the drift phase, and the yardsticks.
void add_drift_counts(nlohmann::ordered_json& json, const TimedSteps& timed);

/// A time per particle and step over what the machine can do.
void print_over_yardsticks(double ns, const Yardsticks& yardsticks);

/// Pairs that the drift phase went through.
void print_pairs(const TimedSteps& timed);

} // namespace keeler
