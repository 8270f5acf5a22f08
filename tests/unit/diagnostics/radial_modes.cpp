#include <keeler/diagnostics/radial_modes.hpp>

#include "states.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <array>

namespace radial_modes_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const ShearingBox box{240.0, 200.0, 1.5, 0.0};
constexpr double mode_k = two_pi * 3 / 240.0;

// A grid of particles moved so that mode 3 has these amplitudes, to first order: Σ/⟨Σ⟩ = 1 + density cos(kx + phase).
Patch with_mode(double density, double phase, double speed_x, double speed_y, double time_orbits) {
  Patch patch = test::uniform(box, 33.0, 4800, 1);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double x = -120.0 + 0.05 * (static_cast<double>(k) + 0.5);
    patch.positions[k].x() = x - density / mode_k * std::sin(mode_k * x + phase);
    const double wave = mode_k * patch.positions[k].x();
    patch.velocities[k] = Vec3(0.3 + speed_x * std::cos(wave), -0.1 + speed_y * std::sin(wave), 0.0);
    patch.velocities[k].y() -= box.shear * patch.positions[k].x();
  }
  patch.time_orbits = time_orbits;
  return patch;
}

} // namespace

TEST_CASE("amplitudes and phases of a mode") {
  const std::vector<RadialMode> modes = radial_modes(with_mode(1e-3, 0.7, 0.02, 0.05, 0.0), 5);
  REQUIRE(modes.size() == 5);
  CHECK(modes[2].n == 3);
  CHECK(std::abs(modes[2].density - std::polar(1e-3, 0.7)) < 2e-6);
  CHECK(std::abs(modes[2].velocity_x - std::complex(0.02, 0.0)) < 5e-5);
  CHECK(std::abs(modes[2].velocity_y - std::complex(0.0, -0.05)) < 5e-5); // sin = Re(−i exp)
  CHECK(modes[2].epicyclic_speed(1.0) == doctest::Approx(std::hypot(0.02, 0.1)).epsilon(2e-3));
  for (const int other : {0, 1, 3, 4}) {
    CHECK(std::abs(modes[static_cast<std::size_t>(other)].density) < 2e-6);
    CHECK(std::abs(modes[static_cast<std::size_t>(other)].velocity_x) < 5e-5);
  }
}

TEST_CASE("an image counts as its particle, and the bits do not depend on the threads") {
  Patch patch = with_mode(0.1, 0.7, 0.02, 0.05, 0.0);
  const RadialMode before = radial_modes(patch, 1)[0];
  patch.positions[7] += box.displacement({1, 2}, patch.offset);
  patch.velocities[7].y() -= box.shear * box.size_x;
  set_threads(1);
  const RadialMode one = radial_modes(patch, 1)[0];
  set_threads(2);
  const RadialMode two = radial_modes(patch, 1)[0];
  CHECK(std::abs(one.density - before.density) < 1e-12);
  CHECK(std::abs(one.velocity_y - before.velocity_y) < 1e-12);
  CHECK(one.density == two.density);
  CHECK(one.velocity_y == two.velocity_y);
}

TEST_CASE("particles at random have the noise foretold") {
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const RadialMode& mode : radial_modes(test::uniform(box, 0.0, 2000, seed), 10))
      squares += std::norm(mode.density) / 200.0;
  CHECK(std::sqrt(squares) == doctest::Approx(radial_mode_noise(test::uniform(box, 0.0, 2000, 1))).epsilon(0.12));
}

TEST_CASE("growth is the slope of the logarithm") {
  const std::array times{0.0, 1.0, 2.0, 4.0};
  const std::array exact{1.0, std::exp(0.3), std::exp(0.6), std::exp(1.2)};
  CHECK(growth(times, exact)->rate == doctest::Approx(0.3).epsilon(1e-12));
  CHECK(*growth(times, exact)->error < 1e-8);
  const std::array noisy{1.0, std::exp(0.5), std::exp(0.4), std::exp(1.2)};
  // By hand: times about 1.75, logarithms about 0.525; Σtt = 8.75, Σtl = 2.425, Σll = 0.7475.
  CHECK(growth(times, noisy)->rate == doctest::Approx(2.425 / 8.75).epsilon(1e-12));
  CHECK(*growth(times, noisy)->error ==
        doctest::Approx(std::sqrt((0.7475 - 2.425 * 2.425 / 8.75) / (2.0 * 8.75))).epsilon(1e-9));
  CHECK(!growth(std::span(times).first(2), std::span(exact).first(2))->error);
  CHECK(!growth(std::span(times).first(1), std::span(exact).first(1)));
  CHECK(!growth(std::array{1.0, 1.0}, std::array{1.0, 2.0}));
  CHECK(!growth(std::array{1.0, 2.0}, std::array{0.0, 2.0}));
}

TEST_CASE("the error of a growth rate holds where the scatter lasts") {
  // noise with a correlation of 2/3 from sample to sample, about a growth of 0.01: the rates of many such series
  // scatter by it
  constexpr int samples = 80, series = 300;
  double squares = 0.0, errors = 0.0;
  for (int s = 0; s < series; ++s) {
    RandomStream random(7, RandomPurpose::position, static_cast<std::uint64_t>(s));
    std::vector<double> times, values;
    double noise = 0.0;
    for (int k = -20; k < samples; ++k) {
      noise = 0.67 * noise + 0.1 * random.normal();
      if (k < 0)
        continue;
      times.push_back(k);
      values.push_back(std::exp(0.01 * k + noise));
    }
    const Growth fit = *growth(times, values);
    squares += (fit.rate - 0.01) * (fit.rate - 0.01) / series;
    errors += *fit.error * *fit.error / series;
  }
  CHECK(std::sqrt(errors / squares) == doctest::Approx(1.0).epsilon(0.2));
}

TEST_CASE("an epicyclic wave travels outward, inward, or half of it either way") {
  // x = X − e cos φ: v_x = κ e sin φ, v_y = ½κ² e cos φ beyond the shear, φ = κt ∓ kx at κt = 0.4
  const double kappa = 0.9, speed = 0.02;
  Patch patch = with_mode(0.0, 0.0, 0.0, 0.0, 0.0);
  const auto modes_with = [&](double outward, double inward) {
    for (std::size_t k = 0; k < patch.size(); ++k) {
      const double wave = mode_k * patch.positions[k].x();
      patch.velocities[k] =
          Vec3(speed * (outward * std::sin(0.4 - wave) + inward * std::sin(0.4 + wave)),
               0.5 * kappa * speed * (outward * std::cos(0.4 - wave) + inward * std::cos(0.4 + wave)) -
                   box.shear * patch.positions[k].x(),
               0.0);
    }
    return radial_modes(patch, 3)[2];
  };
  CHECK(std::abs(modes_with(1.0, 0.0).outward(kappa) - std::polar(speed, -0.4)) < 1e-6);
  CHECK(std::abs(modes_with(1.0, 0.0).inward(kappa)) < 1e-6);
  CHECK(std::abs(modes_with(0.0, 1.0).inward(kappa) - std::polar(speed, 0.4)) < 1e-6);
  CHECK(std::abs(modes_with(0.0, 1.0).outward(kappa)) < 1e-6);
  const RadialMode both = modes_with(0.7, 0.3);
  CHECK(2.0 * (std::norm(both.outward(kappa)) + std::norm(both.inward(kappa))) ==
        doctest::Approx(std::pow(both.epicyclic_speed(kappa), 2)).epsilon(1e-9));
}

TEST_CASE("a growing epicyclic oscillation has its growth rate, whatever its phase") {
  std::vector<Patch> patches;
  for (int s = 0; s < 10; ++s) {
    const double orbits = 0.13 * s, time = two_pi * orbits, amplitude = 0.02 * std::exp(0.05 * time);
    // v_x and v_y exchange: v_x = κ e sin t, v_y = ½ κ² e cos t, at the same wave.
    Patch patch = with_mode(0.0, 0.0, amplitude * std::sin(time), 0.5 * amplitude * std::cos(time), orbits);
    patch.frequencies.kappa = 1.0;
    patches.push_back(patch);
  }
  const std::vector<RadialModeAnalysis> modes = analyze_radial_modes(patches, 3);
  REQUIRE(modes.size() == 3);
  CHECK(modes[2].wavelength == doctest::Approx(80.0));
  REQUIRE(modes[2].growth);
  CHECK(modes[2].growth->rate == doctest::Approx(0.05).epsilon(1e-3));
  CHECK(*modes[2].growth->error < 1e-4);
  CHECK(modes[2].speed == doctest::Approx(0.02 * 1.22 * patches[0].orbital_frequency).epsilon(0.1));
}

} // namespace radial_modes_test
