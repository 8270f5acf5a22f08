// `keeler run --check`: all invariants at each step. It only looks, so a run has the same bits with it.
#pragma once

#include "invariants.hpp"

#include <optional>

namespace keeler {

class StepCheck {
public:
  /// Both must outlive it.
  StepCheck(const Scene& scene, Simulation& simulation);
  ~StepCheck();
  StepCheck(const StepCheck&) = delete;
  StepCheck& operator=(const StepCheck&) = delete;

  /// Right before a step.
  void begin() { before_ = before_step(simulation_); }

  /// Right after it. Throws InvariantError that names the first invariant that does not hold.
  void end() const;

private:
  const Scene& scene_;
  Simulation& simulation_;
  NeighbourAudit audit_;
  std::optional<BeforeStep> before_;
};

} // namespace keeler
