#include <keeler/quantities/views.hpp>

#include <doctest/doctest.h>

namespace views_test {

using namespace keeler;
using namespace keeler::quantities;

Record example() {
  Record mode{{{{"n", unit::none, "n"}, std::uint64_t{1}}, {{"wavelength", unit::metres, "wavelength"}, 50.0}}, {}};
  return {{{{"dispersion", unit::metres_per_second, "dispersion", "", Spread::none, Forms::si_and_radius},
            std::vector{1.0, 2.0, 3.0}},
           {{"total_viscosity", unit::viscosity, "viscosity", "", Spread::error, Forms::all}, Uncertain{8.0, 0.5}},
           {{"wake_pitch", unit::degrees, "pitch"}, Unknown{"there are no wakes"}},
           {{"steady", unit::none, "steady"}, true},
           {{"clusters.count", unit::none, ""}, std::uint64_t{7}},
           {{"modes", unit::none, "mode"}, std::vector{mode}}},
          {2.0, 1.0, 2.0}};
}

TEST_CASE("JSON has each number in its systems of units, and objects for dots") {
  CHECK(json_of(example()).dump() ==
        R"({"dispersion_m_s":[1.0,2.0,3.0],"dispersion_r_omega":[0.5,1.0,1.5],"total_viscosity_m2_s":8.0,)"
        R"("total_viscosity_error_m2_s":0.5,"total_viscosity_r2_omega":2.0,"total_viscosity_g2_sigma2_omega3":2.0,)"
        R"("wake_pitch_degrees":null,"steady":true,"clusters":{"count":7},"modes":[{"n":1,"wavelength_m":50.0}]})");
  CHECK(json_of(example(), UnitSystem::gravity)["dispersion_g_sigma_omega"][0] == 0.5);
  CHECK(json_of(example(), UnitSystem::radius)["total_viscosity_error_r2_omega"] == 0.125);
}

TEST_CASE("a row has a column for each axis and no errors") {
  CHECK(row_of(example(), UnitSystem::si).dump() ==
        R"({"dispersion_x_m_s":1.0,"dispersion_y_m_s":2.0,"dispersion_z_m_s":3.0,"total_viscosity_m2_s":8.0,)"
        R"("wake_pitch_degrees":null,"steady":true,"clusters.count":7})");
}

TEST_CASE("text") {
  CHECK(lines_of(example()) ==
        "dispersion                         1 2 3 m/s = 0.5 1 1.5 r Omega\n"
        "viscosity                          8 +- 0.5 m^2/s = 2 r^2 Omega = 2 G^2 Sigma^2/Omega^3\n"
        "pitch                              not known because there are no wakes\n"
        "steady                             yes\n"
        "mode                               n 1, wavelength 50 m\n");
  Record asked{{{{"clusters.gap"}, 0.01}, {{"modes"}, std::vector<Record>()}}, {}, true};
  CHECK(lines_of(asked) == "clusters.gap                       0.01\nmodes                              none\n");
  CHECK(json_of(asked).dump() == R"({"clusters":{"gap":0.01},"modes":[]})");
  asked.asked = false;
  CHECK(lines_of(asked).empty());
  CHECK(table_of(example())[1] == std::vector<std::string>{"viscosity", "8 ± 0.5 m²/s = 2 r² Ω = 2 G² Σ²/Ω³"});
}

TEST_CASE("the manual's table") {
  const Quantity viscosity{"total_viscosity", unit::viscosity, "", "the sum", Spread::error, Forms::si_and_radius};
  CHECK(markdown_of(std::vector{viscosity}) ==
        "| name | unit | meaning |\n|---|---|---|\n"
        "| `total_viscosity_m2_s`, `total_viscosity_error_m2_s`, `total_viscosity_r2_omega` | m²/s | the sum |\n");
}

} // namespace views_test
