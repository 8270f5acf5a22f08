#include <keeler/light/scattering.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <map>

namespace scattering_test {

using namespace keeler;
using namespace keeler::light;

namespace {

const std::map<std::string, bool> all_laws = {{"callisto", true},
                                              {"power_law=1.5", true},
                                              {"isotropic", true},
                                              {"henyey_greenstein=-0.6", true},
                                              {"henyey_greenstein=0.9", true},
                                              {"lambert", false},
                                              {"lommel_seeliger", false}};

Vec3 at(double cosine, double azimuth) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// Mean over the disc that an observer at phase angle α sees, by a midpoint rule over the disc.
double disc_brightness(const ScatteringLaw& law, double alpha) {
  const Vec3 to = Vec3::UnitZ(), from(std::sin(alpha), 0.0, std::cos(alpha));
  constexpr int rings = 60, sectors = 120;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double s2 = (i + 0.5) / rings, phi = two_pi * (j + 0.5) / sectors; // equal areas of the disc
      const Vec3 normal(std::sqrt(s2) * std::cos(phi), std::sqrt(s2) * std::sin(phi), std::sqrt(1.0 - s2));
      sum += law.brightness(normal, to, from);
    }
  return sum / (rings * sectors);
}

} // namespace

TEST_CASE("a sphere scatters the fraction albedo of the light that meets it, under each law") {
  for (const auto& entry : all_laws) {
    const bool of_particle = entry.second;
    const SharedLaw law = law_named(entry.first, 0.7);
    CHECK(law->of_particle() == of_particle);
    // ϖ = 2 ∫ (I/F) sin α dα, since I/F = ϖ P/4
    const int steps = of_particle ? 2000 : 200;
    double sum = 0.0;
    for (int k = 0; k < steps; ++k) {
      const double alpha = pi * (k + 0.5) / steps;
      sum += 2.0 *
             (of_particle ? law->brightness(Vec3::UnitZ(), Vec3::UnitZ(), at(std::cos(alpha), 0.3))
                          : disc_brightness(*law, alpha)) *
             std::sin(alpha) * pi / steps;
    }
    INFO("law ", entry.first);
    CHECK(sum == doctest::Approx(0.7).epsilon(of_particle ? 1e-4 : 2e-3));
  }
}

TEST_CASE("drawn directions and weights are those of the brightness") {
  // ∫ f(from) (I/F)/π dω = E[weight f(from)] for any f; the polynomials tell directions apart.
  const Vec3 normal = at(0.9, 1.0), to = at(0.4, 0.2);
  const Vec3 axis = at(-0.3, 2.0);
  for (const auto& entry : all_laws) {
    const std::string& name = entry.first;
    const SharedLaw law = law_named(name, 0.8);
    double exact[3] = {0, 0, 0}, drawn[3] = {0, 0, 0};
    constexpr int steps = 300, draws = 400000;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < 2 * steps; ++j) {
        const Vec3 from = at(-1.0 + 2.0 * (i + 0.5) / steps, pi * (j + 0.5) / steps);
        const double part = law->brightness(normal, to, from) / pi * (2.0 / steps) * (pi / steps), f = from.dot(axis);
        exact[0] += part, exact[1] += part * f, exact[2] += part * f * f;
      }
    RandomStream random(3, RandomPurpose::sample, 0);
    for (int k = 0; k < draws; ++k) {
      const Scattering one = law->scatter(normal, to, random);
      const double f = one.from.dot(axis);
      drawn[0] += one.weight / draws, drawn[1] += one.weight * f / draws, drawn[2] += one.weight * f * f / draws;
    }
    CAPTURE(name);
    for (int moment = 0; moment < 3; ++moment) {
      CAPTURE(moment);
      CHECK(drawn[moment] == doctest::Approx(exact[moment]).epsilon(0.004).scale(0.5));
    }
  }
}

TEST_CASE("a surface that is given as a function is the law of that function") {
  const SharedLaw lambert = surface_law([](double in, double, double) { return 3.0 * in; }, 0.6);
  const SharedLaw seeliger = surface_law([](double in, double out, double) { return in / (in + out); }, 0.6);
  const SharedLaw named[] = {law_named("lambert", 0.6), law_named("lommel_seeliger", 0.6)};
  const Vec3 normal = at(0.9, 1.0);
  CHECK(!lambert->of_particle());
  for (const double cosine : {0.95, 0.5, 0.1})
    for (const double azimuth : {0.0, 1.3, 3.0}) {
      const Vec3 to = at(0.4, 0.2), from = at(cosine, azimuth);
      CAPTURE(cosine);
      CAPTURE(azimuth);
      CHECK(lambert->brightness(normal, to, from) ==
            doctest::Approx(named[0]->brightness(normal, to, from)).epsilon(1e-9).scale(1e-9));
      CHECK(seeliger->brightness(normal, to, from) ==
            doctest::Approx(named[1]->brightness(normal, to, from)).epsilon(0.004));
    }
  // and one with a phase angle: what is drawn is what is shown, and a sphere scatters the fraction that is asked for
  const SharedLaw own = surface_law([](double in, double, double phase) { return in * (1.0 + std::cos(phase)); }, 0.7);
  constexpr int steps = 300, draws = 100000;
  const Vec3 to = at(0.4, 0.2), axis = at(-0.3, 2.0);
  double exact[2] = {0, 0}, drawn[2] = {0, 0}, sphere = 0.0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < 2 * steps; ++j) {
      const Vec3 from = at(-1.0 + 2.0 * (i + 0.5) / steps, pi * (j + 0.5) / steps);
      const double part = own->brightness(normal, to, from) / pi * (2.0 / steps) * (pi / steps);
      exact[0] += part, exact[1] += part * from.dot(axis);
    }
  RandomStream random(3, RandomPurpose::sample, 0);
  for (int k = 0; k < draws; ++k) {
    const Scattering one = own->scatter(normal, to, random);
    drawn[0] += one.weight / draws, drawn[1] += one.weight * one.from.dot(axis) / draws;
  }
  for (int moment = 0; moment < 2; ++moment)
    CHECK(drawn[moment] == doctest::Approx(exact[moment]).epsilon(0.005).scale(0.5));
  for (int k = 0; k < 200; ++k) {
    const double alpha = pi * (k + 0.5) / 200;
    sphere += 2.0 * disc_brightness(*own, alpha) * std::sin(alpha) * pi / 200;
  }
  CHECK(sphere == doctest::Approx(0.7).epsilon(0.004));
  CHECK_THROWS_AS(surface_law([](double, double, double) { return -1.0; }, 0.5), UsageError);
  CHECK_THROWS_AS(surface_law([](double, double, double) { return 0.0; }, 0.5), UsageError);
}

TEST_CASE("surface laws are reciprocal") {
  for (const char* const name : {"lambert", "lommel_seeliger"}) {
    const SharedLaw law = law_named(name, 0.5);
    const Vec3 n = at(0.8, 0.1), a = at(0.6, 1.2), b = at(0.95, -2.0);
    CHECK(law->brightness(n, a, b) * n.dot(a) == doctest::Approx(law->brightness(n, b, a) * n.dot(b)));
  }
}

TEST_CASE("phase functions have their published forms") {
  const auto phase_function = [](const char* name, double alpha) {
    return 4.0 * law_named(name, 1.0)->brightness(Vec3::UnitZ(), Vec3::UnitZ(), at(std::cos(alpha), 0.0));
  };
  // Henyey & Greenstein: normalised as it is
  CHECK(phase_function("henyey_greenstein=-0.5", 0.0) == doctest::Approx(0.75 / 0.125).epsilon(1e-6));
  CHECK(phase_function("henyey_greenstein=-0.5", pi) == doctest::Approx(0.75 / 3.375).epsilon(1e-6));
  // Callisto: C_n = 0.153 for n = 3.092 in P = C_n (π − α)^n (Dones, Cuzzi & Showalter 1993)
  CHECK(phase_function("callisto", 0.0) == doctest::Approx(0.153 * std::pow(pi, 3.092)).epsilon(5e-3));
  CHECK(phase_function("callisto", 1.0) == doctest::Approx(0.153 * std::pow(pi - 1.0, 3.092)).epsilon(5e-3));
  CHECK(phase_function("isotropic", 2.0) == doctest::Approx(1.0));
}

TEST_CASE("laws of the calling program, and words that are none") {
  add_law("half_moon",
          [](double albedo) { return particle_law([](double a) { return a < 1.0 ? 2.0 : 0.0; }, albedo); });
  CHECK(law_named("half_moon", 1.0)->brightness(Vec3::UnitZ(), Vec3::UnitZ(), at(std::cos(2.0), 0.0)) == 0.0);
  CHECK_THROWS_AS(add_law("half_moon", nullptr), UsageError);
  CHECK_THROWS_AS(add_law("lambert", nullptr), UsageError);
  CHECK_THROWS_AS(law_named("lambret", 0.5), UsageError);
  CHECK_THROWS_AS(law_named("lambert=2", 0.5), UsageError);
  CHECK_THROWS_AS(law_named("henyey_greenstein=1.5", 0.5), UsageError);
  CHECK_THROWS_AS(law_named("henyey_greenstein=x", 0.5), UsageError);
  CHECK_THROWS_AS(law_named("lambert", 0.0), UsageError);
  CHECK_THROWS_AS(particle_law([](double a) { return a - 1.0; }, 0.5), UsageError);
  CHECK_THROWS_AS(particle_law([](double) { return 0.0; }, 0.5), UsageError);
}

} // namespace scattering_test
