#include <keeler/states/streamlines.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/units.hpp>
#include <keeler/states/initial.hpp>

#include <doctest/doctest.h>

#include <complex>

using namespace keeler;

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
  CHECK(largest_overlap(patch).depth == 0.0);
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
