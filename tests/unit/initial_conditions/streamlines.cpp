#include <keeler/initial_conditions/streamlines.hpp>

#include "draws.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/radial_modes.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <complex>

namespace streamlines_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

constexpr double length = 60.0;

// The result of radial_modes() for uniformly filled streamlines at a time: 2 ⟨exp(−ikx)⟩ over X.
std::complex<double> density_of(const Streamlines& s, int n, double kappa_time) {
  constexpr int samples = 4000;
  const double k = two_pi * n / length;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double guiding_x = length * (i + 0.5) / samples;
    const Elements el = s.elements(guiding_x);
    const double e_cos = el.e_cos * std::cos(kappa_time) - el.e_sin * std::sin(kappa_time);
    sum += 2.0 / samples * std::polar(1.0, -k * (guiding_x - e_cos));
  }
  return sum;
}

Scene modes_scene(const std::string& particles, const std::string& modes) {
  return parse_scene(R"(
[planet]
orbital_frequency = 1.95e-4
[box]
size = [200.0, 100.0]
[particles]
density = 900.0
)" + particles + "\n[particles.modes]\n" +
                         modes + "\n[time]\nstep = 5e-3\nend = 1.0\n",
                     "s.toml");
}

} // namespace

TEST_CASE("a mode has the amplitude and the phase of the density that is asked for, and travels the right way") {
  const double q = 0.3, phase = 0.7, bessel = 0.2966378; // 2 J₁(0.3)
  for (const double turned : {0.0, 0.5, 2.0}) {
    Streamlines outward, inward, standing;
    outward.add_outward(3, length, q, phase);
    inward.add_inward(3, length, q, phase);
    standing.add_standing(3, length, q, phase);
    CHECK(std::abs(density_of(outward, 3, turned) - std::polar(bessel, phase - turned)) < 1e-6);
    CHECK(std::abs(density_of(inward, 3, turned) - std::polar(bessel, phase + turned)) < 1e-6);
    CHECK(std::abs(density_of(standing, 3, turned) - std::polar(q * std::cos(turned), phase)) < 0.004);
  }
  Streamlines two;
  two.add_outward(1, length, 0.05, 0.2);
  two.add_inward(4, length, 0.05, 1.0);
  CHECK(std::abs(density_of(two, 1, 0.0) - std::polar(0.05, 0.2)) < 1e-3);
  CHECK(std::abs(density_of(two, 4, 0.0) - std::polar(0.05, 1.0)) < 1e-3);
}

TEST_CASE("streamlines of several modes do not cross, and each place lies on one of them") {
  Streamlines s;
  s.add_outward(2, length, 0.4, 0.3);
  s.add_inward(5, length, 0.3, 2.0);
  s.add_standing(1, length, 0.2, -1.0);
  for (int k = 0; k < 600; ++k) {
    const double guiding_x = 0.1 * k;
    const auto place = [&](double at) { return at - s.elements(at).e_cos; };
    CHECK(s.spacing(guiding_x) >= 0.1);
    CHECK((place(guiding_x + 5e-4) - place(guiding_x - 5e-4)) / 1e-3 ==
          doctest::Approx(s.spacing(guiding_x)).epsilon(1e-5));
    CHECK(std::fabs(s.guiding_x(place(guiding_x)) - guiding_x) < 1e-12);
  }
}

TEST_CASE("a scene's mode is measured as it was seeded, for any number of threads") {
  struct Case {
    const char* direction;
    double outward, inward; // fractions of κe = q/k
  };
  for (const Case& c : {Case{"outward", 1.0, 0.0}, {"inward", 0.0, 1.0}, {"standing", 0.5, 0.5}}) {
    CAPTURE(c.direction);
    const Scene scene = modes_scene("optical_depth = 1.0\nsizes = { law = \"equal\", radius = 1.0 }",
                                    std::string(c.direction) + " = [[1, 0.1, 40.0]]");
    set_threads(1);
    const Patch one = initial_patch(scene);
    set_threads(2);
    const Patch patch = initial_patch(scene);
    CHECK(std::equal(patch.positions.begin(), patch.positions.end(), one.positions.begin()));
    CHECK(std::equal(patch.velocities.begin(), patch.velocities.end(), one.velocities.begin()));
    CHECK(cells::largest_overlap(patch).depth == 0.0);
    const diagnostics::RadialMode mode = diagnostics::radial_modes(patch, 1)[0];
    CHECK(std::abs(mode.density - std::polar(0.1, 40.0 * pi / 180.0)) <
          2.0 * diagnostics::radial_mode_noise(patch)); // 0.025
    // κe = 3.2 m/rad; amplitudes of the random velocities of 2 m/rad have an rms of 0.05
    const double whole = 0.1 * 200.0 / two_pi;
    CHECK(std::fabs(std::abs(mode.outward(1.0)) - c.outward * whole) < 0.12);
    CHECK(std::fabs(std::abs(mode.inward(1.0)) - c.inward * whole) < 0.12);
  }
}

TEST_CASE("without collisions a mode neither grows nor decays: after an orbit it is what it was") {
  const std::string count = test::sanitized ? "1000" : "4000";
  const Scene scene = modes_scene("count = " + count + "\nsizes = { law = \"equal\", radius = 1e-5 }",
                                  "outward = [[1, 0.1, 0.0]]\ninward = [[2, 0.1, 50.0]]");
  Simulation simulation(scene, initial_patch(scene));
  std::vector<Patch> patches;
  for (int orbit = 0; orbit <= 4; ++orbit) {
    patches.push_back(simulation.patch());
    patches.back().time_orbits = orbit;
    for (int step = 0; step < 200; ++step)
      simulation.advance();
  }
  const std::vector<diagnostics::RadialModeAnalysis> modes = diagnostics::analyze_radial_modes(patches, 2);
  for (const diagnostics::RadialModeAnalysis& mode : modes) {
    REQUIRE(mode.growth);
    CHECK(std::fabs(mode.growth->rate) < 1e-9);
    CHECK(mode.density_amplitude == doctest::Approx(0.1).epsilon(0.5)); // 4000 at random: 0.03
    CHECK(mode.density_amplitude ==
          doctest::Approx(
              std::abs(diagnostics::radial_modes(patches[0], 2)[static_cast<std::size_t>(mode.n) - 1].density))
              .epsilon(1e-9));
  }
}

TEST_CASE("streamlines bunch to 1 - q, thin out to 1 + q, and each place lies on one of them") {
  for (const double q : {0.0, 0.3, 0.9}) {
    const Streamlines s = Streamlines::bunched(3, 60.0, q);
    double closest = 2.0, widest = 0.0;
    for (int k = 0; k < 6000; ++k) {
      const double guiding_x = 0.01 * k - 30.0;
      const auto place = [&](double at) { return at - s.elements(at).e_cos; };
      const double spacing = (place(guiding_x + 5e-4) - place(guiding_x - 5e-4)) / 1e-3;
      closest = std::min(closest, spacing);
      widest = std::max(widest, spacing);
      CHECK(std::fabs(s.guiding_x(place(guiding_x)) - guiding_x) < 1e-12); // roundings of 30 m over 1 − q
    }
    CHECK(closest == doctest::Approx(1.0 - q).epsilon(1e-4)); // the samples are 0.003 of a phase apart
    CHECK(widest == doctest::Approx(1.0 + q).epsilon(1e-4));
  }
}

TEST_CASE("a patterned scene starts on its streamlines, with its dispersion about them and without overlap") {
  const Scene scene = parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [100.0, 60.0]
[particles]
optical_depth = 0.5
density = 900.0
velocity_dispersion = 3.0
sizes = { law = "equal", radius = 0.5 }
streamlines = { waves = 2, bunching = 0.6, inclination = 4.0 }
[time]
end = 1.0
)",
                                  "s.toml");
  const Patch patch = initial_patch(scene);
  CHECK(cells::largest_overlap(patch).depth == 0.0);
  const double k = two_pi * 2 / 100.0;
  std::complex<double> pattern = 0.0;
  double inclination = 0.0, height = 0.0, e2 = 0.0;
  const double count = static_cast<double>(patch.size());
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const Elements el = elements_from({patch.positions[i], patch.velocities[i]}, patch.frequencies, Rotation());
    const std::complex<double> e(el.e_cos, el.e_sin), phase = std::polar(1.0, k * el.guiding_x);
    pattern += e * std::conj(phase) / count;
    e2 += std::norm(e - 0.6 / k * phase) / count;
    inclination += el.i_cos / count;
    height += el.i_sin / count;
  }
  CHECK(std::abs(pattern - 0.6 / k) < 0.1); // random eccentricities of 1.5 m in each direction, 1900 of them: 0.034
  CHECK(std::fabs(inclination - 4.0 * 0.5) < 0.1);
  CHECK(std::fabs(height) < 0.1);
  // two directions of c_x = 1.5 m/rad; guiding centres that differ from their streamline's turn the pattern a little
  CHECK(std::sqrt(e2 / 2.0) == doctest::Approx(1.5).epsilon(0.2));
}

} // namespace streamlines_test
