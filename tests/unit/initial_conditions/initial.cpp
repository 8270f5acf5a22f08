#include <keeler/initial_conditions/initial.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/scene/layer.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace initial_test {

using namespace keeler;

namespace {

Scene scene_of(const std::string& planet, const std::string& particles, double side) {
  return parse_scene(fmt::format(R"(
[planet]
orbital_frequency = 1.95e-4
{}
[box]
size = [{}, {}]
[particles]
density = 900.0
{}
[collisions]
restitution = {{ law = "constant", value = 0.1 }}
[time]
end = 1.0
)",
                                 planet, side, 1.1 * side, particles),
                     "s.toml");
}

const std::string spheres = "sizes = { law = \"equal\", radius = 1.0 }\n";

} // namespace

TEST_CASE("dense scenes whose equilibria exist start, at the default dispersion") {
  struct Case {
    std::string planet, particles;
    bool flat_topped;
  };
  for (const Case& c :
       {Case{"", "optical_depth = 3.0\n", true}, Case{"vertical_ratio = 3.6", "optical_depth = 1.6\n", false},
        Case{"vertical_ratio = 3.6", "optical_depth = 1.6\nvelocity_dispersion = 1.0\n", false}}) {
    const Scene scene = scene_of(c.planet, c.particles + spheres, 50.0);
    CHECK(scene.notices.empty() == !c.flat_topped);
    const Patch patch = initial_patch(scene);
    CHECK(cells::largest_overlap(patch).depth == 0.0);
    CHECK(diagnostics::optical_depth(patch) == doctest::Approx(scene.optical_depth()).epsilon(1e-12));
    // 5 % for separation and sampling: 1/√(2N) of 2000 particles or more
    const double height = layer_height(scene.optical_depth(), scene.particles.layer_sizes(),
                                       scene.particles.velocity_dispersion, scene.planet.frequencies.nu);
    CHECK(diagnostics::scale_height(patch) == doctest::Approx(height).epsilon(0.08));
    const double c_x = diagnostics::velocity_dispersion(patch).x(), count = static_cast<double>(patch.size());
    CHECK(std::fabs(c_x / scene.particles.velocity_dispersion - 1.0) < 3.0 / std::sqrt(2.0 * count));
  }
}

TEST_CASE("tau, the moments of the law and the dispersion are those of the scene within three standard errors") {
  const Scene scene =
      scene_of("", "optical_depth = 0.8\nsizes = { law = \"power\", exponent = 3.0, min = 0.5, max = 5.0 }", 120.0);
  const Patch patch = initial_patch(scene);
  const double count = static_cast<double>(patch.size());
  double weight = 0.0; // Σ m² / (Σ m)²: 1 / effective number of particles in mass-weighted means
  double masses = 0.0;
  for (const double mass : patch.masses) {
    weight += mass * mass;
    masses += mass;
  }
  weight /= masses * masses;
  const auto& sizes = scene.particles.sizes;
  const double mean_area = sizes.mean_power(2);
  const double area_error = std::sqrt((sizes.mean_power(4) / (mean_area * mean_area) - 1.0) / count);
  CHECK(std::fabs(diagnostics::optical_depth(patch) / 0.8 - 1.0) < 3.0 * area_error);
  const double c_x = scene.particles.velocity_dispersion * sizes.mean_power(1);
  CHECK(std::fabs(diagnostics::velocity_dispersion(patch).x() / c_x - 1.0) < 3.0 * std::sqrt(0.5 * weight));
  CHECK(cells::largest_overlap(patch).depth == 0.0);
}

TEST_CASE("a moonlet in a table of radii does not thicken the layer of the grains") {
  const auto height = [](double moonlet) { // of the grains
    Scene scene = scene_of("", "count = 4000\n" + spheres, 160.0);
    std::vector<double> radii(4000, 1.0);
    radii.back() = moonlet;
    scene.particles.sizes = particles::listed_sizes(radii);
    const Patch patch = initial_patch(scene);
    double squares = 0.0;
    for (std::size_t k = 0; k < patch.size(); ++k)
      squares += patch.radii[k] == 1.0 ? patch.positions[k].z() * patch.positions[k].z() : 0.0;
    return std::sqrt(squares / 4000.0);
  };
  CHECK(height(40.0) < 1.3 * height(1.0)); // with 94 % of the mass: with ⟨r³⟩/⟨r²⟩ of all it would be 13 m
}

} // namespace initial_test
