#include "scenes.hpp"

#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace contact_rates_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

namespace {

// Adds: steps of 1e-3 orbit, each with a kick by the tree.
std::vector<std::string> custom(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), "quality=custom");
  return overrides;
}

Scene a_ring(const std::vector<std::string>& overrides = {}) {
  return load_scene(KEELER_SOURCE_DIR "/examples/a-ring-wakes/scene.toml", custom(overrides));
}

// Checks a value within a factor.
void check_near(double value, double expected, double factor) {
  CAPTURE(value);
  CAPTURE(expected);
  CHECK(value < expected * factor);
  CHECK(value > expected / factor);
}

} // namespace

TEST_CASE("contact rates agree with equilibria without self-gravity") {
  // collisions per particle and orbit, restitution 0.5, by REBOUND 6c44115f; all contacts, few of them slow
  const double reference[][2] = {{0.1, 1.92}, {0.5, 9.97}, {1.0, 21.6}};
  for (const auto& [depth, rate] : reference)
    check_near(contact_rates(depth, 0.5, layer_crowding(depth)).all(), rate, 1.1);
}

TEST_CASE("contact rates follow the vertical frequency") {
  // docs/dev/estimate.md: fast and slow together, counted in runs of 300 particles over an orbit, from the second on
  struct Case {
    double vertical_ratio, optical_depth, restitution, counted;
  };
  for (const Case& c : {Case{2.0, 0.5, 0.5, 31.1}, Case{2.0, 1.0, 0.5, 76.5}, Case{2.0, 1.64, 0.5, 143.5},
                        Case{2.0, 2.5, 0.5, 322.0}, Case{3.6, 0.5, 0.5, 126.5}, Case{3.6, 1.0, 0.5, 668.7},
                        Case{3.6, 1.64, 0.5, 1089.6}, Case{3.6, 2.5, 0.5, 2314.0}, Case{3.6, 2.5, 0.3, 17923.7},
                        Case{2.0, 1.64, 0.1, 3861.7}, Case{6.0, 1.64, 0.9, 244.6}, Case{0.5, 1.0, 0.5, 10.1}}) {
    CAPTURE(c.vertical_ratio);
    CAPTURE(c.optical_depth);
    CAPTURE(c.restitution);
    const double crowding = layer_crowding(c.optical_depth);
    check_near(contact_rates(c.optical_depth, c.restitution, crowding, 1.0, c.vertical_ratio).all(), c.counted, 2.0);
  }
  const Scene waves = load_scene(KEELER_SOURCE_DIR "/examples/overstability/scene.toml");
  check_near(scene_contacts(waves).smooth.all(), 1100.0, 1.5);
}

TEST_CASE("contact rates in wakes agree with the study of solvers") {
  // docs/theory/gravity.md: 218 to 247 collisions per particle and orbit, over orbits 1 to 4
  check_near(scene_contacts(a_ring()).wakes.fast, 230.0, 1.25);
  // far below the Roche density self-gravity adds few contacts
  const SceneContacts light = scene_contacts(a_ring({"particles.density=20"}));
  check_near(light.wakes.fast, light.smooth.fast, 1.2);
}

TEST_CASE("contact rates in layers compressed by self-gravity agree with counted rates") {
  // docs/dev/estimate.md: fast and slow together, counted in runs of 500 particles
  struct Case {
    const char* density;
    double optical_depth, restitution, counted;
  };
  for (const Case& c : {Case{"900", 0.5, 0.1, 1610.0}, Case{"900", 2.0, 0.1, 11814.0}, Case{"900", 3.0, 0.1, 38446.0},
                        Case{"300", 1.0, 0.1, 878.0}, Case{"100", 2.0, 0.1, 971.0}, Case{"900", 2.0, 0.5, 765.0}}) {
    CAPTURE(c.density);
    CAPTURE(c.optical_depth);
    const Scene scene = load_scene(KEELER_SOURCE_DIR "/examples/equilibrium/scene.toml",
                                   {fmt::format("particles.optical_depth={}", c.optical_depth),
                                    fmt::format("particles.density={}", c.density),
                                    fmt::format("collisions.restitution={{law=\"constant\",value={}}}", c.restitution),
                                    "particles.velocity_dispersion=14", "gravity={}"});
    check_near(scene_contacts(scene).smooth.all(), c.counted, 1.5);
  }
}

TEST_CASE("wakes need a box of half their critical wavelength") {
  const SceneContacts narrow = scene_contacts(a_ring({"box.size_in_wavelengths=[0.4, 4]"}));
  CHECK(narrow.wakes.fast == narrow.smooth.fast);
  const SceneContacts wide = scene_contacts(a_ring({"box.size_in_wavelengths=[0.6, 4]"}));
  CHECK(wide.wakes.fast > 2.0 * wide.smooth.fast);
}

TEST_CASE("a lower restitution gives more contacts, above all slow ones") {
  for (const double depth : {0.1, 1.0, 3.0}) {
    ContactRates elastic = contact_rates(depth, 0.9, layer_crowding(depth));
    CHECK(elastic.slow < 0.01 * elastic.fast);
    for (const double restitution : {0.6, 0.3, 0.0}) {
      const ContactRates lossy = contact_rates(depth, restitution, layer_crowding(depth));
      CHECK(lossy.fast > elastic.fast);
      CHECK(lossy.slow > elastic.slow);
      elastic = lossy;
    }
  }
}

TEST_CASE("a law that depends on radii is asked for an impact of typical particles") {
  const Scene scene =
      parse_scene(test::least, "s.toml",
                  {"collisions.restitution={ law = \"viscoelastic\", reference_speed = 6e-4, reference_radius = 1 }"});
  CHECK(typical_restitution(scene) == doctest::Approx(0.396).epsilon(1e-3)); // 3 r Ω is the reference speed
  CHECK(scene_contacts(scene).smooth.all() > 0.0);
}

} // namespace contact_rates_test
