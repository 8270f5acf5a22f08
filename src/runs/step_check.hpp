// `keeler run --check`: all invariants after each step. The checks only read, so the run has the same bits with them.
#pragma once

#include "invariants.hpp"

#include <optional>

namespace keeler::runs {

class StepCheck {
public:
  /// Registers an audit of the neighbour lists. Both arguments must outlive the check.
  StepCheck(const Scene& scene, Simulation& simulation);
  ~StepCheck();
  StepCheck(const StepCheck&) = delete;
  StepCheck& operator=(const StepCheck&) = delete;

  /// Saves the state. Call it directly before a step.
  void begin() { before_ = before_step(simulation_); }

  /// Checks the state after the step. Precondition: begin() was called. Throws InvariantError that names the first
  /// invariant that does not hold, on all ranks. Collective, as begin().
  void end();

private:
  void require(const char* invariant, const std::string& fault) const;

  const Scene& scene_;
  Simulation& simulation_;
  collision::NeighbourAudit audit_;
  std::optional<BeforeStep> before_;
};

} // namespace keeler::runs
