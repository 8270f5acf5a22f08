// The table of the numbers of keeler bench drift, step and light.
#pragma once

#include <keeler/bench/drift.hpp>
#include <keeler/bench/step.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler::cli {

/// The result of a bench and its settings.
struct TimedStep {
  const bench::StepBenchSettings& settings;
  const bench::StepBench& bench;
};
struct TimedDrift {
  const bench::DriftBenchSettings& settings;
  std::string sizes; ///< name of settings.sizes
  const bench::DriftBench& bench;
};

quantities::Record record_of(const TimedStep& step);
quantities::Record record_of(const TimedDrift& drift);

std::vector<quantities::Quantity> step_bench_quantities();
std::vector<quantities::Quantity> drift_bench_quantities();
std::vector<quantities::Quantity> light_bench_quantities(); // bench_light.cpp

} // namespace keeler::cli
