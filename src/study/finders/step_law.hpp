// The paper's law for the cost of a run against the time step: T(h) = A/h + B h^d.
#pragma once

#include <span>

namespace keeler {

struct StepLaw {
  double a = 0.0, b = 0.0, d = 0.0;
  double largest_error = 0.0; ///< of the fit, relative
  double best_step = 0.0;     ///< where the fitted law is least; 0 when B = 0
};

/// Least squares of the relative errors, A and B not negative, d in [0.25, 4]. At least three steps.
StepLaw fit_step_law(std::span<const double> steps, std::span<const double> times);

} // namespace keeler
