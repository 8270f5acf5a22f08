// What keeler bench tells of timed steps, as numbers with names.
#pragma once

#include <keeler/bench/drift.hpp>
#include <keeler/bench/step.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler {

/// A bench and what it was asked for.
struct TimedStep {
  const StepBenchSettings& settings;
  const StepBench& bench;
};
struct TimedDrift {
  const DriftBenchSettings& settings;
  std::string sizes; ///< in words
  const DriftBench& bench;
};

Record record_of(const TimedStep& step);
Record record_of(const TimedDrift& drift);

std::vector<Quantity> step_bench_quantities();
std::vector<Quantity> drift_bench_quantities();

} // namespace keeler
