#include "finders/step_law.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace step_law_test {

using namespace keeler;
using namespace keeler::study;

TEST_CASE("the law of the step is found again from its own values") {
  const std::vector<double> steps = {1e-4, 3e-4, 1e-3, 3e-3, 1e-2};
  std::vector<double> times;
  for (const double h : steps)
    times.push_back(2e-3 / h + 40.0 * std::pow(h, 0.8));
  const StepLaw law = fit_step_law(steps, times);
  CHECK(law.a == doctest::Approx(2e-3).epsilon(1e-3));
  CHECK(law.b == doctest::Approx(40.0).epsilon(0.03));
  CHECK(law.d == doctest::Approx(0.8).epsilon(0.01));
  CHECK(law.largest_error < 1e-3);
  CHECK(law.best_step == doctest::Approx(std::pow(2e-3 / (40.0 * 0.8), 1.0 / 1.8)).epsilon(0.03));
  for (std::size_t k = 0; k < steps.size(); ++k)
    times[k] = 2e-3 / steps[k];
  CHECK(fit_step_law(steps, times).best_step == 0.0); // the longer, the better
}

} // namespace step_law_test
