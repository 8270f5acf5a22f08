#include "documented.hpp"
#include "scenes.hpp"

#include <keeler/runs/measurement.hpp>

#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/quantities/views.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace measurement_test {

using namespace keeler;
using namespace keeler::runs;

TEST_CASE("every measured number has names of its own and says what it is; the manual has the table") {
  test::check_documented(measured_quantities(), "docs/manual/numbers.md");
}

TEST_CASE("a number of a snapshot is the mean over the snapshots") {
  const Scene scene = test::small_scene();
  const Patch patch = initial_patch(scene);
  const std::vector<Patch> patches = {patch, patch};
  const Measurement m = measure(patches, TransportReport::of_snapshot(patch, scene.gravity));
  const double n = m.mean_over_snapshots([](const Patch& p) { return static_cast<double>(p.size()); });
  CHECK(n == static_cast<double>(patch.size()));
  const nlohmann::ordered_json json = json_of(record_of(m));
  CHECK(json["snapshots"] == 2);
  CHECK(json["particle_count"] == patch.size());
  CHECK(json["collisional_viscosity_m2_s"].is_null()); // a single snapshot does not determine it
  CHECK(json["translational_viscosity_r2_omega"].is_number());
}

TEST_CASE("the gravity parameter turns a viscosity in r² Ω into one in G² Σ²/Ω³") {
  const Scene scene = test::small_scene();
  const Patch patch = initial_patch(scene);
  const nlohmann::ordered_json json =
      json_of(record_of(measure({&patch, 1}, TransportReport::of_snapshot(patch, scene.gravity))));
  const double parameter = json["gravity_parameter"], in_radii = json["translational_viscosity_r2_omega"],
               by_gravity = json["translational_viscosity_g2_sigma2_omega3"];
  CHECK(in_radii / parameter == doctest::Approx(by_gravity).epsilon(1e-14));
  const double omega = patch.orbital_frequency, r = json["mean_radius_m"], sigma = json["surface_density_kg_m2"];
  CHECK(parameter == doctest::Approx(std::pow(newton_g_si * sigma / (r * omega * omega), 2)).epsilon(1e-14));
}

} // namespace measurement_test
