#include "scenes.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/derived.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace derived_test {

using namespace keeler;
using namespace keeler::test;

namespace {

Scene preset_scene(const std::string& preset) {
  return parse_scene(changed(least, "orbital_frequency = 2e-4", "preset = \"" + preset + "\""), "s.toml");
}

} // namespace

TEST_CASE("the presets stand at their places") {
  // Distances for which the frequencies were computed. 3e-4: five digits of the frequencies, and J4, which the formula
  // leaves out and which is largest for the C ring.
  const std::vector<std::pair<std::string, double>> places = {
      {"saturn-c-ring", 84.0e6},        {"saturn-b-ring", 100.0e6},
      {"saturn-b-ring-outer", 105.0e6}, {"saturn-cassini-division", 120.0e6},
      {"saturn-a-ring", 130.0e6},       {"saturn-f-ring", 140.221e6}};
  for (const auto& [name, distance] : places) {
    const PlanetSettings planet = preset_scene(name).planet;
    CAPTURE(planet.orbital_frequency);
    CHECK(distance_from_saturn(planet) == doctest::Approx(distance).epsilon(3e-4));
    // an axisymmetric planet without density at the ring: κ² + ν² = 2Ω² (Laplace), to the digits given
    const Frequencies& f = planet.frequencies;
    CHECK(f.kappa * f.kappa + f.nu * f.nu == doctest::Approx(2.0).epsilon(2e-5));
  }
}

// κ² + ν² = 2Ω² is broken only by rounding where J2 alone is taken; the distance follows from the mass,
// a³ = 2GM/(Ω² + κ²) (for J2 alone). Masses: of Haumea Ragozzine & Brown 2009, of Quaoar Morgado et al. 2023.
// Chariklo's must be in the range of Leiva et al. 2017, to 5 %.
TEST_CASE("the presets of small bodies stand at their places") {
  const auto mass_at = [](const std::string& preset, double distance) {
    const PlanetSettings planet = preset_scene(preset).planet;
    const Frequencies& f = planet.frequencies;
    CHECK(f.kappa * f.kappa + f.nu * f.nu == doctest::Approx(2.0).epsilon(2e-3));
    const double mean = 0.5 * std::pow(planet.orbital_frequency, 2) * (1.0 + f.kappa * f.kappa);
    return mean * std::pow(distance, 3) / newton_g_si;
  };
  CHECK(mass_at("haumea-ring", 2287e3) == doctest::Approx(4.006e21).epsilon(1e-3));
  CHECK(mass_at("quaoar-q1r", 4057e3) == doctest::Approx(1.20e21).epsilon(1e-3));
  const double chariklo = mass_at("chariklo-c1r", 385.9e3);
  CHECK(chariklo > 0.95 * 6e18);
  CHECK(chariklo < 8e18);
}

TEST_CASE("the A-ring example has the numbers that the design gives for it") {
  const Scene scene = load_scene(KEELER_SOURCE_DIR "/examples/a-ring-wakes/scene.toml");
  const Derived d = derive(scene);
  CHECK(scene.notices.empty());
  CHECK(d.particle_count == doctest::Approx(9600).epsilon(0.002)); // "about 9600"
  CHECK(d.lambda_cr == doctest::Approx(61.4).epsilon(0.002));      // "61 m"
  CHECK(d.surface_density == doctest::Approx(400).epsilon(1e-4));  // half a particle of 9600
  CHECK(d.optical_depth == doctest::Approx(0.5).epsilon(1e-4));
  CHECK(d.hill_parameter == doctest::Approx(0.82 * std::cbrt(600.0 / 900) * 1.3).epsilon(3e-4));
  CHECK(d.steps == 2400);
  CHECK(d.memory_mb == doctest::Approx(40.0).epsilon(0.1)); // 33 MB and some 700 bytes a particle
}

TEST_CASE("the memory that is foretold is that of the meshes too") {
  const auto megabytes = [](const std::string& gravity) {
    return derive(parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [1000, 1000]
[particles]
count = 20000
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
end = 1.0
)" + gravity,
                              "scene"))
        .memory_mb;
  };
  const double without = megabytes("");
  CHECK(without < 60.0);
  // 12 · 10⁶ waves: 2²⁷ nodes
  const double nodes = 0x1p27, radial = megabytes("[gravity]\nsolver = 'axisymmetric'\nshortest_wavelength = 1e-4\n");
  CHECK(radial - without > 1e-6 * 24 * nodes); // one number a node, half a complex one, a whole one on each thread
  CHECK(radial - without < 1e-6 * 64 * nodes * threads());
  // at most 2²¹ nodes and 64 a particle, 8 bytes each
  const double fine = megabytes("[gravity]\nsolver = 'mesh'\nmesh_spacing = 0.1\n"),
               coarse = megabytes("[gravity]\nsolver = 'mesh'\n");
  CHECK(fine - coarse > 5.0);
  CHECK(fine - coarse < 1e-6 * 16 * (0x1p21 + 64 * 20000));
}

TEST_CASE("the equilibrium example has about 1500 particles and no gravity") {
  const Scene scene = load_scene(KEELER_SOURCE_DIR "/examples/equilibrium/scene.toml");
  CHECK(std::fabs(static_cast<double>(scene.particles.count) - 1500) < 20);
  CHECK(!scene.gravity);
  CHECK(scene.time.end_step == 15000);
}

TEST_CASE("Toomre's Q and wavelength belong together") {
  // c_x = Q × 3.36 G Σ / κ and λ = 4π²GΣ/κ²: at Q = 1 the ratio c_x / (κ λ) is 3.36 / 4π²
  const PlanetSettings planet = preset_scene("saturn-a-ring").planet;
  const double kappa = planet.orbital_frequency * planet.frequencies.kappa;
  const double speed = 3.36 / (4 * pi * pi) * kappa * critical_wavelength(400, planet);
  CHECK(toomre_q(400, speed, planet) == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("the mid-plane filling is that of sampled particles") {
  // the slow twin: particles of a power law in a Gaussian layer, the volume of the slices of each at z = 0
  const SizeLaw sizes = power_sizes(3.0, 0.5, 3.0);
  const Crowd crowd = crowd_of(sizes, 20000);
  const double depth = 0.4, dispersion = 20.0, nu = 1.3; // thick compared with a particle, as the formula has it
  const std::vector<double> radii = draw_radii(sizes, 20000, 3);
  const double height = layer_height(depth, crowd, dispersion, nu);
  double area_sum = 0.0, sliced = 0.0;
  for (const double r : radii) {
    area_sum += pi * r * r;
    constexpr int slices = 200; // centres at z within r of the mid-plane, each cutting a disc π (r² − z²) out of it
    for (int k = 0; k < slices; ++k) {
      const double z = r * (2.0 * (k + 0.5) / slices - 1.0);
      const double density = std::exp(-0.5 * z * z / (height * height)) / (std::sqrt(two_pi) * height);
      sliced += density * pi * (r * r - z * z) * 2.0 * r / slices;
    }
  }
  // 1 %: the particles' own size, (r/H)²/10 with H = 9.6 m, and the sampling of the moments
  CHECK(midplane_filling(depth, crowd, dispersion, nu) == doctest::Approx(depth * sliced / area_sum).epsilon(0.01));
}

TEST_CASE("a single body counts by the mass of the others, however many times a list is drawn") {
  // the slow twin: R = Σ m (1 − m/M) / Σ area, over the particles themselves
  const auto drawn = [](const SizeLaw& sizes, std::size_t count) {
    double cubes = 0.0, sixths = 0.0, squares = 0.0;
    for (const double r : draw_radii(sizes, count, 1)) {
      squares += r * r;
      cubes += r * r * r;
      sixths += std::pow(r, 6);
    }
    return (cubes - sixths / cubes) / squares;
  };
  std::vector<double> radii(500, 1.0);
  radii.front() = 20.0;
  const SizeLaw moonlet = listed_sizes(radii);
  CHECK(crowd_of(moonlet, 500).radius == doctest::Approx(drawn(moonlet, 500)).epsilon(1e-9));
  CHECK(crowd_of(moonlet, 500).radius < 1.1); // ⟨r³⟩/⟨r²⟩ is 9.4: the grains share the area with the moonlet
  CHECK(crowd_of(moonlet, 50000).radius == doctest::Approx(drawn(moonlet, 50000)).epsilon(1e-9));
  CHECK(crowd_of(moonlet, 50000).radius > 9.0); // a hundred moonlets are a crowd
}

TEST_CASE("the layer's height is that of the reference equilibria, and the filling can be inverted") {
  // REBOUND 6c44115f, equal spheres of 1 m without self-gravity: c_z and H; 5 %
  const Crowd equal{1.0, 1.0};
  const double reference[][3] = {{0.1, 1.80, 1.86}, {0.5, 1.45, 1.73}, {1.0, 1.17, 1.74}};
  for (const auto& [depth, c_z, height] : reference)
    CHECK(layer_height(depth, equal, c_z / vertical_fraction, 1.0) == doctest::Approx(height).epsilon(0.05));
  for (const double dispersion : {1.0, 2.0, 7.0}) {
    const double filling = midplane_filling(0.8, equal, dispersion, 1.1);
    CHECK(dispersion_for_filling(0.8, equal, 1.1, filling) == doctest::Approx(dispersion).epsilon(1e-12));
    CHECK(optical_depth_for_filling(equal, dispersion, 1.1, filling) == doctest::Approx(0.8).epsilon(1e-12));
  }
  CHECK(dispersion_for_filling(0.1, equal, 1.0, 0.4) == 0.0);
}

} // namespace derived_test
