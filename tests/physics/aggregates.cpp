// A placed aggregate is held together by its gravity or torn by tides, as its Hill parameter says. Aggregates form and
// last above r_h = 1.1 to 1.2, and none below 0.7 (Karjalainen & Salo 2004; Salo 1995).
#include "scenes.hpp"

#include <keeler/diagnostics/clusters.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

constexpr double gap = 0.2; // of the sum of the radii: a pile that rattles is one body

Scene scene_of(double hill_parameter) { // r_h = 0.82 (ρ/900)^(1/3) (a/10⁸), a = 140,221 km
  const double density = 900.0 * std::pow(hill_parameter / (0.82 * 1.40221), 3);
  return parse_scene(fmt::format("planet.preset = \"saturn-f-ring\"\nbox.size = [60, 80]\n"
                                 "gravity.solver = \"direct\"\ntime = {{ step = 2e-3, end = 1.0 }}\n"
                                 "[particles]\ncount = 100\ndensity = {}\n"
                                 "sizes = {{ law = \"equal\", radius = 1.0 }}\n"
                                 "[[particles.aggregate]]\ncount = 100\nposition = [8, -5, 0]\nfilling_factor = 0.5\n",
                                 density),
                     "test scene");
}

// Of all mass, after an orbit.
double largest_share(double hill_parameter) {
  const Scene scene = scene_of(hill_parameter);
  Simulation simulation(scene, initial_patch(scene));
  while (simulation.orbits() < 1.0)
    simulation.advance();
  const Patch patch = simulation.patch();
  return diagnostics::analyze_clusters(std::span(&patch, 1), gap).largest_mass_fraction;
}

} // namespace

TEST_CASE("an aggregate stays together for an orbit at r_h 1.25, and is torn at 0.65") {
  const double bound = largest_share(1.25), torn = largest_share(0.65);
  MESSAGE("largest cluster's share: " << bound << " at r_h 1.25, " << torn << " at 0.65");
  CHECK(bound > 0.95);
  CHECK(torn < 0.1);
}
