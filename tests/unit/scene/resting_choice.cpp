#include "scenes.hpp"

#include <keeler/scene/load.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/resting_choice.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

namespace resting_choice_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

namespace {

constexpr double density_at_1 = 742.9; // kg/m³ of the A ring's preset at r_h = 1

std::string ring(double optical_depth, double r_h, double kick_interval, const std::string& more = "") {
  return fmt::format(
      "[planet]\npreset = \"saturn-a-ring\"\n[box]\nsize = [60, 60]\n[particles]\noptical_depth = {}\n"
      "density = {}\nvelocity_dispersion = 14\nsizes = {{ law = \"equal\", radius = 1.0 }}\n[gravity]\nkick_every = 1\n"
      "[time]\nstep = {}\nend = 1\n{}",
      optical_depth, density_at_1 * std::pow(r_h, 3), kick_interval, more);
}

bool carries(double optical_depth, double r_h, double kick_interval, const std::string& more = "") {
  return parse_scene(ring(optical_depth, r_h, kick_interval, more), "s.toml").gravity->carries();
}

std::string moonlet(double radius, double density) {
  return fmt::format("[[moonlet]]\nradius = {}\ndensity = {}\n", radius, density);
}

} // namespace

// The table: loss over the work of the shear − 1, when bouncing contacts had the velocity of the drift and so lost what
// kicks gave to them; 2300 spheres of examples/hard-spheres, three orbits.
TEST_CASE("the energy that kicks give to bouncing contacts agrees with measurements within a factor of 2.2") {
  struct Row {
    double optical_depth, r_h, interval, energy;
  };
  const Row table[] = {{1, 0.80, 1e-3, 0.001}, {1, 0.80, 2e-3, 0.003}, {1, 0.80, 5e-3, 0.014}, {1, 0.93, 5e-3, 0.029},
                       {1, 1.10, 1e-3, 0.013}, {1, 1.10, 2e-3, 0.028}, {1, 1.10, 5e-3, 0.077}, {1, 1.20, 5e-3, 0.204},
                       {2, 0.60, 5e-3, 0.002}, {2, 0.80, 5e-3, 0.033}, {2, 0.93, 5e-3, 0.081}, {2, 1.10, 5e-3, 0.196},
                       {2, 1.20, 5e-3, 0.338}, {3, 0.60, 5e-3, 0.004}, {3, 0.80, 5e-3, 0.037}, {3, 0.93, 5e-3, 0.130},
                       {3, 1.10, 5e-3, 0.45},  {3, 1.20, 5e-3, 1.294}, {1, 1.10, 10e-3, 0.323}};
  for (const Row& row : table) {
    CAPTURE(row.optical_depth);
    CAPTURE(row.r_h);
    CAPTURE(row.interval);
    CHECK(energy_of_kicks(row.optical_depth, row.r_h, row.interval) < 2.2 * row.energy);
    CHECK(energy_of_kicks(row.optical_depth, row.r_h, row.interval) > row.energy / 2.2);
  }
}

TEST_CASE("contacts at rest are carried where many spheres rest, or aggregates last") {
  CHECK(carries(3.0, 0.927, 5e-3)); // kicks give 12 % of the energy of the shear
  CHECK(carries(3.0, 0.927, 1e-3));
  CHECK(carries(2.0, 0.80, 5e-3));
  CHECK(carries(1.0, 0.93, 5e-3));
  CHECK(carries(0.2, 1.01, 1e-3));
  CHECK_FALSE(carries(3.0, 0.65, 5e-3));
  CHECK_FALSE(carries(1.0, 0.80, 5e-3));
  CHECK_FALSE(carries(0.5, 0.93, 1e-3)); // the wakes of the A ring
  CHECK_FALSE(carries(3.0, 0.927, 1e-4));
}

TEST_CASE("grains stay on a moonlet below the r_h at which they stay on each other") {
  CHECK_FALSE(carries(0.3, 0.75, 1e-3));
  CHECK(carries(0.3, 0.75, 1e-3, moonlet(10.0, 900.0)));
  CHECK_FALSE(carries(0.3, 0.75, 1e-3, moonlet(10.0, 50.0))); // tides take them
  CHECK_FALSE(carries(0.3, 0.75, 1e-3, moonlet(1.5, 900.0))); // a particle like others
}

TEST_CASE("the resolved scene holds the choice, and a continued run keeps it") {
  const Scene scene = parse_scene(ring(3.0, 0.93, 5e-3), "s.toml");
  CHECK(scene.resolved.find("\nresting_contacts = \"carried\"\n") != std::string::npos);
  // another kick interval does not change the choice of a run
  const std::string later = changed(scene.resolved, "step = 0.005", "step = 0.0001");
  CHECK(parse_stored_scene(later, "stored").gravity->carries());
  const std::string named =
      changed(ring(3.0, 0.93, 5e-3), "[gravity]\n", "[gravity]\nresting_contacts = \"bounced\"\n");
  CHECK_FALSE(parse_scene(named, "s.toml").gravity->carries());
}

TEST_CASE("a scene of a program without contacts at rest goes on without them") {
  const std::string old =
      changed(parse_scene(ring(3.0, 1.2, 5e-3), "s.toml").resolved, "resting_contacts = \"carried\"\n", "");
  CHECK_FALSE(parse_stored_scene(old, "stored").gravity->carries());
}

TEST_CASE("a start from a file gives the choice of a fresh start with equal particles") {
  for (const double r_h : {0.65, 0.93, 1.1}) {
    const Scene fresh = parse_scene(ring(3.0, r_h, 5e-3), "s.toml");
    const Scene open = parse_scene(ring(3.0, r_h, 5e-3), "s.toml", {}, "/no/such.hdf");
    CHECK(leaves_resting_open(open));
    CHECK(open.resolved.find("\nresting_contacts = \"auto\"\n") != std::string::npos);
    const Scene decided = decided_by(open, scale_of(fresh));
    CHECK_FALSE(leaves_resting_open(decided));
    CHECK(decided.gravity->carries() == fresh.gravity->carries());
    CHECK(decided.motion == changed(fresh.motion, "particles.seed = 1\n", ""));
    CHECK(decided.notices == open.notices);
    CHECK(changed(open.resolved, "resting_contacts = \"auto\"",
                  fresh.gravity->carries() ? "resting_contacts = \"carried\"" : "resting_contacts = \"bounced\"") ==
          decided.resolved);
    CHECK(decided_by(decided, {}).resolved == decided.resolved);
  }
}

TEST_CASE("a table of particles leaves the choice to its particles") {
  CHECK(leaves_resting_open(parse_table_scene(ring(3.0, 0.93, 5e-3), "s.toml").scene));
}

} // namespace resting_choice_test
