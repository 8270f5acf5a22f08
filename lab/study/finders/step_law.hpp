// The paper's law for the cost of a run against the time step: T(h) = A/h + B h^d.
#pragma once

#include <span>

namespace keeler::study {

struct StepLaw {
  double a = 0.0, b = 0.0, d = 0.0;
  double largest_error = 0.0; ///< of the fit, relative
  double best_step = 0.0;     ///< minimum of the fitted law; 0 when B = 0
};

/// Fits the law by least squares of the relative errors, with A, B ≥ 0 and d in [0.25, 4].
/// Precondition: `steps` and `times` have equal lengths, at least 3.
StepLaw fit_step_law(std::span<const double> steps, std::span<const double> times);

} // namespace keeler::study
