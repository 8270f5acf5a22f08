#include "occultation_record.hpp"
#include "photometry_record.hpp"

#include "unit/runs/documented.hpp"

#include <doctest/doctest.h>

namespace light_records_test {

using namespace keeler;
using namespace keeler::light;

TEST_CASE("every number of light says what it is; the manual has the tables") {
  test::check_documented(photometry_quantities(), "docs/manual/numbers.md");
  test::check_documented(occultation_quantities(), "docs/manual/numbers.md");
  test::check_documented(wake_model_quantities(), "docs/manual/numbers.md");
}

} // namespace light_records_test
