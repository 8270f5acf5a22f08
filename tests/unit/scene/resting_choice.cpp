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

bool carries(double optical_depth, double r_h, double kick_interval = 1e-3, const std::string& more = "") {
  return parse_scene(ring(optical_depth, r_h, kick_interval, more), "s.toml").gravity->carries();
}

std::string moonlet(double radius, double density) {
  return fmt::format("[[moonlet]]\nradius = {}\ndensity = {}\n", radius, density);
}

} // namespace

// The table: processor time of a run whose contacts bounce over that of one which carries them, as in
// docs/dev/contact-solver.md.
TEST_CASE("contacts at rest are carried where that saves time, and not where it costs more than a few per cent") {
  struct Row {
    double optical_depth, r_h, saving;
  };
  const Row table[] = {{0.3, 0.93, 0.92},  {0.3, 0.98, 0.98},  {0.5, 0.80, 0.97},  {0.5, 0.87, 1.00},
                       {0.5, 0.93, 1.19},  {0.5, 0.98, 1.15},  {0.6, 0.87, 0.91},  {0.6, 0.93, 1.44},
                       {0.75, 0.80, 0.74}, {0.75, 0.84, 1.09}, {0.75, 0.87, 1.32}, {0.75, 0.93, 1.49},
                       {0.75, 0.98, 1.33}, {1, 0.797, 1.16},   {1, 0.80, 1.48},    {1, 0.87, 2.53},
                       {1, 0.927, 2.06},   {2, 0.797, 1.03},   {2, 0.927, 2.61},   {3, 0.797, 0.97},
                       {3, 0.927, 1.06}};
  for (const Row& row : table) {
    CAPTURE(row.optical_depth);
    CAPTURE(row.r_h);
    CHECK((carries(row.optical_depth, row.r_h) ? row.saving > 0.95 : row.saving < 1.2));
  }
}

TEST_CASE(
    "contacts at rest are carried where aggregates last, and not in the wakes of the A ring at any kick interval") {
  CHECK(carries(0.2, 1.01));
  CHECK(carries(0.1, 1.0001));
  CHECK_FALSE(carries(0.1, 0.9999));
  CHECK_FALSE(carries(3.0, 0.65));
  for (const double kick_interval : {1e-4, 1e-3, 1e-2})
    CHECK_FALSE(carries(0.5, 0.93, kick_interval));
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
  CHECK(parse_stored_scene(scene.resolved, "stored").gravity->carries());
  const std::string other = changed(scene.resolved, "resting_contacts = \"carried\"", "resting_contacts = \"bounced\"");
  CHECK_FALSE(parse_stored_scene(other, "stored").gravity->carries());
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
