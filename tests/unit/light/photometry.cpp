#include <keeler/light/photometry.hpp>

#include "chandrasekhar.hpp"
#include "states.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <atomic>

namespace photometry_test {

using namespace keeler;
using namespace keeler::light;

namespace {

constexpr double degree = pi / 180.0;

Photometry one_sight(const Patch& patch, const Sight& sight, const SharedLaw& law, std::uint64_t rays) {
  PhotometrySettings settings;
  settings.law = law;
  settings.rays = rays;
  return photometry({&patch, 1}, {&sight, 1}, settings).front();
}

// Deviation in standard errors; `more` is what else is uncertain in the expected value.
double sigmas(const Estimate& found, double expected, double more = 0.0) {
  return (found.value - expected) / std::hypot(found.error, more);
}

} // namespace

TEST_CASE("angles of a sight") {
  const Sight sight{{20.0 * degree, 30.0 * degree}, {10.0 * degree, 50.0 * degree}};
  CHECK(sight.longitude() == doctest::Approx(330.0 * degree));
  CHECK(std::cos(sight.phase()) == doctest::Approx(sight.observer.direction().dot(sight.sun.direction())));
  CHECK(sight.lit());
  CHECK(!Sight{{-0.1, 0.0}, {0.2, 0.0}}.lit());
  for (const double phase : {5.0, 40.0, 120.0}) {
    const Sight at = sight_at_phase({12.0 * degree, -70.0 * degree}, 15.0 * degree, phase * degree);
    CHECK(at.phase() == doctest::Approx(phase * degree));
    CHECK(at.sun.elevation == doctest::Approx(15.0 * degree));
    CHECK(at.observer.azimuth == doctest::Approx(-70.0 * degree));
  }
  CHECK_THROWS_AS(sight_at_phase({0.2, 0.0}, 0.4, 0.1), UsageError);
  CHECK_THROWS_AS(sight_at_phase({0.2, 0.0}, 0.4, 3.0), UsageError);
}

TEST_CASE("a thin random layer scatters once as Chandrasekhar's single scattering, from both faces") {
  // Filling factor 0.004. The number of spheres in the box is finite: 60000 make the depth along a ray uncertain by
  // less than 0.4 %.
  const SharedLaw law = law_named("callisto", 0.6);
  for (const double tau : {0.1, 2.0}) {
    const Patch patch = test::random_layer(tau, 4e-3, 60000, 4, 0.31);
    for (const double observer : {80.0, -30.0})
      for (const double sun : {50.0, 15.0}) {
        const Sight sight{{observer * degree, 40.0 * degree}, {sun * degree, 130.0 * degree}};
        const Photometry found = one_sight(patch, sight, law, round_rays);
        const double mu = std::fabs(std::sin(sight.observer.elevation)), mu0 = std::sin(sight.sun.elevation);
        const double of_sphere =
            0.6 * 4.0 / 4.0 * law->brightness(Vec3::UnitZ(), sight.observer.direction(), sight.sun.direction()) / 0.6;
        const double expected = sight.lit()
                                    ? of_sphere * mu0 / (mu + mu0) * (1.0 - std::exp(-tau * (1.0 / mu + 1.0 / mu0)))
                                    : of_sphere * mu0 / (mu0 - mu) * (std::exp(-tau / mu0) - std::exp(-tau / mu));
        CAPTURE(tau);
        CAPTURE(observer);
        CAPTURE(sun);
        CAPTURE(found.single.value);
        CAPTURE(expected);
        CHECK(std::fabs(sigmas(found.single, expected, 0.006 * expected * std::max(1.0, tau / mu * 0.3))) < 3.5);
        CHECK(std::fabs(sigmas(found.transmission, std::exp(-tau / mu), 0.005 * tau / mu * std::exp(-tau / mu))) < 3.5);
      }
  }
}

TEST_CASE("isotropic layers scatter as Chandrasekhar's X and Y functions") {
  const double elevations[] = {60.0, 20.0};
  for (const double albedo : {0.5, 1.0})
    for (const double tau : {0.1, 4.0}) {
      const double out = std::sin(elevations[0] * degree), in = std::sin(elevations[1] * degree);
      const test::IsotropicLayer exact(albedo, tau, {out, in});
      const Patch patch = test::random_layer(tau, 4e-3, 60000, 4, 0.31);
      for (const bool lit : {true, false}) {
        const Sight sight{{(lit ? 1.0 : -1.0) * elevations[0] * degree, 0.0}, {elevations[1] * degree, 2.0}};
        const Photometry found = one_sight(patch, sight, isotropic_law(albedo), round_rays);
        const double expected = lit ? exact.reflected(0, 1) : exact.transmitted(0, 1);
        CAPTURE(albedo);
        CAPTURE(tau);
        CAPTURE(lit);
        CAPTURE(found.reflectance.value);
        CAPTURE(expected);
        CHECK(std::fabs(sigmas(found.reflectance, expected, 0.006 * expected)) < 3.5);
        CHECK(found.reflectance.value == doctest::Approx(found.single.value + found.multiple.value));
      }
    }
}

TEST_CASE("the equations of X and Y conserve light, and have Chandrasekhar's values") {
  for (const double depth : {0.1, 1.0, 4.0})
    CHECK(test::IsotropicLayer(1.0, depth, {0.777, 0.3}).leaves(0, depth) == doctest::Approx(1.0).epsilon(2e-3));
}

TEST_CASE("what goes into a dense layer without absorption comes out") {
  // By reciprocity of surfaces the albedo of the patch for the observer's direction is the mean weight of the paths
  // that leave: with ϖ = 1 an isotropic sky of I/F = 1 (π I = π F) looks, through the patch, everywhere as bright as
  // the sky. Here: the plane albedo plus both transmissions by integrating I/F over the Sun's directions.
  const Patch patch = test::dense_layer(20.0, 20.0, 4.0, 160, 2, 3.0);
  for (const char* const name : {"lambert", "lommel_seeliger", "isotropic", "callisto"}) {
    const SharedLaw law = law_named(name, 1.0);
    std::vector<Sight> sights;
    std::vector<double> weights;
    const double nodes[] = {0.1127016654, 0.5, 0.8872983346};
    const double parts[] = {0.2777777778, 0.4444444444, 0.2777777778};
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j)
        for (const double face : {1.0, -1.0}) {
          sights.push_back({{50.0 * degree, 0.4}, {face * std::asin(nodes[k]), two_pi * (j + 0.37) / 4}});
          weights.push_back(parts[k] / 4.0);
        }
    PhotometrySettings settings;
    settings.law = law;
    settings.rays = 8192;
    const std::vector<Photometry> all = photometry({&patch, 1}, sights, settings);
    // the sky's intensity 1 gives the flux dω at each direction: I/F = π I per flux, so I = Σ (I/F)/π dω
    double sky = all.front().transmission.value, error = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      sky += all[k].reflectance.value / pi * two_pi * weights[k];
      error += std::pow(all[k].reflectance.error * 2.0 * weights[k], 2);
    }
    CAPTURE(name);
    CAPTURE(sky);
    CHECK(std::fabs(sky - 1.0) < 4.0 * std::sqrt(error) + 0.01); // 0.01: the rule of 3 × 4 directions
  }
}

TEST_CASE("a dense layer is reciprocal") {
  const Patch patch = test::dense_layer(20.0, 20.0, 4.0, 160, 2, 3.0);
  for (const char* const name : {"lambert", "lommel_seeliger", "callisto"}) {
    const SharedLaw law = law_named(name, 0.9);
    const Bearing a{50.0 * degree, 0.4}, b{12.0 * degree, 2.1}, c{-30.0 * degree, 1.0};
    for (const Bearing& other : {b, c}) {
      const Photometry there = one_sight(patch, {a, other}, law, 8 * round_rays),
                       back = one_sight(patch, {other, a}, law, 8 * round_rays);
      const double mu_a = std::fabs(std::sin(a.elevation)), mu_b = std::fabs(std::sin(other.elevation));
      const double one = there.reflectance.value * mu_a, two = back.reflectance.value * mu_b;
      CAPTURE(name);
      CAPTURE(one);
      CAPTURE(two);
      CHECK(std::fabs(one - two) < 3.5 * std::hypot(there.reflectance.error * mu_a, back.reflectance.error * mu_b));
      CHECK(there.reflectance.error < 0.01 * there.reflectance.value);
    }
  }
}

TEST_CASE("the numbers are the same for any number of threads, alone and in a table") {
  const Patch patch = test::dense_layer(20.0, 20.0, 4.0, 160, 2, 3.0);
  const Sight sights[] = {{{0.4, 0.0}, {0.3, 1.0}}, {{0.9, 0.0}, {-0.3, 1.0}}};
  PhotometrySettings settings;
  settings.law = law_named("callisto", 0.5);
  settings.rays = 20000;
  const int before = threads();
  set_threads(1);
  const std::vector<Photometry> one = photometry({&patch, 1}, sights, settings);
  set_threads(3);
  const std::vector<Photometry> three = photometry({&patch, 1}, sights, settings);
  const std::vector<Photometry> alone = photometry({&patch, 1}, {&sights[1], 1}, settings);
  set_threads(before);
  REQUIRE(one.size() == 2);
  CHECK(one[0].rays == 24576);
  for (int k = 0; k < 2; ++k) {
    CHECK(one[k].reflectance.value == three[k].reflectance.value);
    CHECK(one[k].reflectance.error == three[k].reflectance.error);
    CHECK(one[k].multiple.value == three[k].multiple.value);
  }
  CHECK(alone[0].reflectance.value == one[1].reflectance.value);
}

TEST_CASE("an error that is asked for is met, and is that of other seeds") {
  const Patch patch = test::dense_layer(20.0, 20.0, 4.0, 160, 2, 3.0);
  const Sight sight{{0.4, 0.0}, {0.3, 1.0}};
  PhotometrySettings settings;
  settings.law = law_named("callisto", 0.5);
  settings.error = 0.01;
  const Photometry met = photometry({&patch, 1}, {&sight, 1}, settings).front();
  CHECK(met.reflectance.error <= 0.01 * met.reflectance.value);
  CHECK(met.reflectance.error > 0.004 * met.reflectance.value);
  settings.max_rays = round_rays;
  settings.error = 1e-4;
  CHECK(photometry({&patch, 1}, {&sight, 1}, settings).front().rays == round_rays);

  settings.error.reset();
  settings.rays = round_rays;
  double mean = 0.0, squares = 0.0, error = 0.0;
  constexpr int seeds = 30;
  for (settings.seed = 1; settings.seed <= seeds; ++settings.seed) {
    const Estimate one = photometry({&patch, 1}, {&sight, 1}, settings).front().reflectance;
    mean += one.value / seeds, squares += one.value * one.value / seeds, error += one.error / seeds;
  }
  const double spread = std::sqrt((squares - mean * mean) * seeds / (seeds - 1));
  CHECK(error / spread == doctest::Approx(1.0).epsilon(0.3)); // the spread of 30 is known to 13 %
}

TEST_CASE("a stop keeps what is done") {
  const Patch patch = test::dense_layer(20.0, 20.0, 4.0, 160, 2, 3.0);
  const std::vector<Sight> sights(4, Sight{{0.4, 0.0}, {0.3, 1.0}});
  PhotometrySettings settings;
  settings.law = law_named("callisto", 0.5);
  settings.rays = 4 * round_rays;
  std::atomic<bool> stop = false;
  const Interruptible by_stop(stop);
  int reports = 0;
  double last = 0.0;
  const std::vector<Photometry> kept = photometry({&patch, 1}, sights, settings, [&](const Progress& progress) {
    CHECK(progress.fraction > last);
    last = progress.fraction;
    stop = ++reports == 6;
  });
  REQUIRE(kept.size() == 2);
  CHECK(kept[0].rays == 4 * round_rays);
  CHECK(kept[1].rays == 2 * round_rays);
}

TEST_CASE("the amplitude and the longitude of the minimum of a known asymmetry") {
  std::vector<Photometry> all;
  for (int k = 0; k < 18; ++k) {
    Photometry one;
    one.sight.observer = {0.3, -10.0 * degree * k};
    one.reflectance = {0.5 - 0.1 * std::cos(2.0 * (10.0 * k - 67.0) * degree), 0.001};
    all.push_back(one);
  }
  const auto asymmetry = brightness_asymmetry(all);
  REQUIRE(asymmetry);
  CHECK(asymmetry->amplitude == doctest::Approx(0.2).epsilon(1e-3));
  CHECK(asymmetry->minimum_longitude == doctest::Approx(67.0 * degree).epsilon(2e-3));
  CHECK(asymmetry->error > 0.0);
  CHECK(!brightness_asymmetry({all.data(), 5}));
}

} // namespace photometry_test
