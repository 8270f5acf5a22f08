// The rates of contacts that `keeler check` reckons with, against contacts counted in short runs. A factor of 1.5 is
// what the estimate promises; the rates themselves differ by 140 over these cases.
#include "physics/scenes.hpp"

#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

using namespace keeler;
using namespace keeler::test;

namespace {

// All contacts, fast and slow: both cost the same.
void check_rate(const Scene& scene, double settle, double average, double expected) {
  Simulation simulation(scene, initial_patch(scene));
  const Means means = settle_and_average(simulation, scene, settle, average);
  const double counted = means.fast + means.slow;
  MESSAGE("counted " << counted << ", expected " << expected);
  CHECK(expected < 1.5 * counted);
  CHECK(counted < 1.5 * expected);
}

std::string constant(double restitution) {
  return fmt::format("{{ law = \"constant\", value = {} }}", restitution);
}

} // namespace

TEST_CASE("contacts without self-gravity, from dilute and lively to dense and lossy") {
  struct Case {
    double optical_depth, restitution, dispersion;
  };
  for (const Case& c : {Case{0.1, 0.5, 2.0}, Case{0.1, 0.1, 1.5}, Case{0.5, 0.3, 2.0}, Case{1.0, 0.1, 2.2},
                        Case{1.5, 0.5, 3.0}, Case{2.0, 0.3, 4.0}}) {
    CAPTURE(c.optical_depth);
    CAPTURE(c.restitution);
    const Scene scene = spheres(c.optical_depth, 600, 2e-3, constant(c.restitution), 3, c.dispersion);
    check_rate(scene, 2.0, 1.0, scene_contacts(scene).smooth.all());
  }
}

TEST_CASE("contacts of particles over a decade of sizes") {
  const Scene scene = parse_scene(R"(
[planet]
orbital_frequency = 1.95e-4
[box]
size = [60.0, 60.0]
[particles]
optical_depth = 0.8
density = 900.0
velocity_dispersion = 6.0
sizes = { law = "power", exponent = 3.0, min = 0.5, max = 5.0 }
[collisions]
restitution = { law = "constant", value = 0.5 }
[time]
step = 2e-3
end = 100.0
)",
                                  "test scene");
  check_rate(scene, 2.0, 1.0, scene_contacts(scene).smooth.all());
}

TEST_CASE("contacts in self-gravity wakes") {
  const Scene scene = parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size_in_wavelengths = [2.5, 2.5]
[particles]
optical_depth = 0.5
density = 450.0
velocity_dispersion = 3.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
solver = "fft"
[time]
step = 4e-3
end = 100.0
)",
                                  "test scene");
  check_rate(scene, 1.5, 1.5, scene_contacts(scene).wakes.all());
}
