#include <keeler/quantities/quantity.hpp>

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <limits>

namespace quantity_test {

using namespace keeler;
using namespace keeler::quantities;

const Quantity viscosity{"total_viscosity", unit::viscosity, "total", "the sum", Spread::error, Forms::all};
const Quantity clusters{"clusters.count", unit::none, "clusters", "how many"};

TEST_CASE("names end in units") {
  CHECK(viscosity.full_name() == "total_viscosity_m2_s");
  CHECK(viscosity.full_name(UnitSystem::gravity) == "total_viscosity_g2_sigma2_omega3");
  CHECK(viscosity.spread_name() == "total_viscosity_error_m2_s");
  CHECK(clusters.full_name(UnitSystem::radius) == "clusters.count");
}

TEST_CASE("a quantity is found by each of its names") {
  for (const char* const name :
       {"total_viscosity", "total_viscosity_m2_s", "total_viscosity_r2_omega", "total_viscosity_error_m2_s"})
    CHECK(viscosity.is_called(name));
  CHECK(clusters.is_called("clusters"));
  CHECK_FALSE(clusters.is_called("cluster"));
  CHECK_FALSE(viscosity.is_called("total"));
}

TEST_CASE("what is not finite is not known") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::holds_alternative<Unknown>(value_of(std::optional(nan))));
  CHECK(std::holds_alternative<Unknown>(value_of(std::optional(Estimate{nan, 1.0}))));
  const Value value = value_of(std::optional(Estimate{2.0, nan}));
  REQUIRE(std::holds_alternative<Uncertain>(value));
  CHECK(std::get<Uncertain>(value).value == 2.0);
  CHECK_FALSE(std::get<Uncertain>(value).spread);
}

TEST_CASE("some of a record, in the order of the names") {
  const Record record{{{viscosity, 1.0}, {clusters, std::uint64_t{3}}}, {}};
  const Record some = only(record, std::vector<std::string>{"clusters", "total_viscosity"});
  REQUIRE(some.entries.size() == 2);
  CHECK(some.entries[0].quantity.name == "clusters.count");
  CHECK(some.asked);
  CHECK_THROWS_WITH_AS(only(record, std::vector<std::string>{"total_viscosty"}),
                       "there is no number 'total_viscosty' here; did you mean 'total_viscosity'?", UsageError);
}

} // namespace quantity_test
