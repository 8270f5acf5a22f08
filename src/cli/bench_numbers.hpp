// The table of the numbers of keeler bench drift and step.
#pragma once

#include <keeler/bench/drift.hpp>
#include <keeler/bench/step.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler {

/// The result of a bench and its settings.
struct TimedStep {
  const StepBenchSettings& settings;
  const StepBench& bench;
};
struct TimedDrift {
  const DriftBenchSettings& settings;
  std::string sizes; ///< name of settings.sizes
  const DriftBench& bench;
};

Record record_of(const TimedStep& step);
Record record_of(const TimedDrift& drift);

std::vector<Quantity> step_bench_quantities();
std::vector<Quantity> drift_bench_quantities();

} // namespace keeler
