#include <keeler/diagnostics/wake_spectrum.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

#include <complex>

namespace wake_spectrum_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const ShearingBox box{245.0, 200.0, 1.5, 0.0};
constexpr double lambda = 61.0;

// All bins together.
WakePower::Bin whole(const WakePower& sums) {
  WakePower::Bin total;
  for (const WakePower::Bin& bin : sums.bins) {
    total.power += bin.power;
    total.k += bin.k;
    total.k_radial += bin.k_radial;
  }
  return total;
}

// Brute force: sums of every wave over every particle, in one bin.
WakePower by_definition(const Patch& patch, int most) {
  WakePower sums;
  sums.snapshots = 1;
  double mass = 0.0, squares = 0.0;
  for (const double m : patch.masses) {
    mass += m;
    squares += m * m;
  }
  const double shot = squares / (mass * mass);
  for (int nx = -most; nx <= most; ++nx)
    for (int ny = 0; ny <= most; ++ny) {
      if (ny == 0 && nx <= 0)
        continue;
      const double ky = two_pi * ny / patch.box.size_y;
      const double kx = (two_pi * nx + ky * patch.offset) / patch.box.size_x, k = std::hypot(kx, ky);
      std::complex<double> wave = 0.0;
      for (std::size_t p = 0; p < patch.size(); ++p)
        wave += patch.masses[p] * std::polar(1.0, -kx * patch.positions[p].x() - ky * patch.positions[p].y());
      const double filter = std::exp(-std::pow(k * wake_smoothing * lambda, 2));
      const double power = filter * (std::norm(wave) / (mass * mass) - shot);
      sums.bins[0].power += power;
      sums.bins[0].k += power * k;
      sums.bins[0].k_radial += power * std::fabs(kx);
      sums.power += power;
      sums.cosine += power * std::cos(2.0 * std::atan2(ky, kx));
      sums.sine += power * std::sin(2.0 * std::atan2(ky, kx));
      sums.noise_squares += std::pow(filter * shot, 2);
    }
  return sums;
}

} // namespace

TEST_CASE("the sums over the mesh are those over all waves and particles") {
  for (const double offset : {0.0, 63.7, 170.2}) {
    CAPTURE(offset);
    Patch patch = test::scattered(box, offset, 3000, 1, test::Wave(box, offset, 4, 1));
    for (std::size_t k = 0; k < patch.size(); ++k)
      patch.masses[k] *= 1.0 + 0.5 * static_cast<double>(k % 3);
    patch.positions[3] += box.displacement({1, -1}, offset); // outside the cell by its eccentricity
    const WakePower fast = wake_power(patch, lambda), slow = by_definition(patch, 30);
    CHECK(fast.snapshots == 1);
    CHECK(fast.noise_squares == doctest::Approx(slow.noise_squares).epsilon(1e-6));
    // Only aliases of waves shorter than two cells differ.
    CHECK(fast.power == doctest::Approx(slow.power).epsilon(2e-3));
    CHECK(whole(fast).power == doctest::Approx(fast.power).epsilon(1e-12));
    CHECK(whole(fast).k == doctest::Approx(whole(slow).k).epsilon(2e-3));
    CHECK(whole(fast).k_radial == doctest::Approx(whole(slow).k_radial).epsilon(2e-3));
    CHECK(std::fabs(fast.cosine - slow.cosine) < 2e-3 * slow.power);
    CHECK(std::fabs(fast.sine - slow.sine) < 2e-3 * slow.power);
  }
}

TEST_CASE("a density wave has its length, direction and contrast, at any shear offset, trailing and leading") {
  struct Case {
    int across, along;
    double offset;
  };
  for (const Case& c :
       {Case{4, 1, 0.0}, Case{4, 1, 63.7}, Case{3, 1, 150.3}, Case{4, 2, 30.1}, Case{5, -1, 120.0}, Case{4, 0, 77.7}}) {
    CAPTURE(c.across);
    CAPTURE(c.along);
    CAPTURE(c.offset);
    const test::Wave wave(box, c.offset, c.across, c.along);
    const WakeWaves waves = wake_waves(wake_power(test::scattered(box, c.offset, 40000, 1, wave), lambda));
    REQUIRE(waves.wavelength);
    CHECK(*waves.wavelength == doctest::Approx(wave.radial_length * std::cos(wave.pitch)).epsilon(0.02));
    CHECK(*waves.radial_wavelength == doctest::Approx(wave.radial_length).epsilon(0.02));
    CHECK(std::fabs(*waves.angle_degrees - wave.pitch * 180.0 / pi) < 0.5);
    const double k = two_pi / (wave.radial_length * std::cos(wave.pitch));
    const double smoothed = std::exp(-0.5 * std::pow(k * wake_smoothing * lambda, 2));
    CHECK(waves.contrast == doctest::Approx(0.8 / std::sqrt(2.0) * smoothed).epsilon(0.03)); // 0.4/0.5 cos(...)
  }
}

TEST_CASE("snapshots add up") {
  const Patch patch = test::scattered(box, 10.0, 5000, 1, test::Wave(box, 10.0, 4, 1));
  WakePower twice = wake_power(patch, lambda);
  const WakeWaves one = wake_waves(twice);
  twice += twice;
  const WakeWaves two = wake_waves(twice);
  CHECK(two.contrast == doctest::Approx(one.contrast).epsilon(1e-14));
  CHECK(*two.wavelength == doctest::Approx(*one.wavelength).epsilon(1e-14));
}

TEST_CASE("particles at random have no wakes") {
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WakePower power = wake_power(test::uniform(box, 10.0 * static_cast<double>(seed), 9600, seed), lambda);
    CHECK(!wake_waves(power).wavelength);
    mean += power.power / std::sqrt(power.noise_squares) / 20.0;
  }
  CHECK(std::fabs(mean) < 4.0 / std::sqrt(20.0)); // the subtracted noise equals the actual noise
}

TEST_CASE("a wavelength that the mesh does not resolve gives no waves") {
  const WakePower power = wake_power(test::uniform(box, 0.0, 2000, 1), 5.0);
  CHECK(power.snapshots == 0);
  CHECK(!wake_waves(power).wavelength);
}

TEST_CASE("weak waves among particles that keep apart: the lengths leave out what is below the noise") {
  // Spheres on a lattice of 2 m, shaken by 0.7 m: far more even than random particles. A wave moves them along x.
  const ShearingBox wide{240.0, 240.0, 1.5, 0.0};
  Patch patch = test::uniform(wide, 0.0, 14400, 1);
  RandomStream random(3, RandomPurpose::position, 1);
  const double k = two_pi * 4 / 240.0;
  for (std::size_t p = 0; p < patch.size(); ++p) {
    const std::size_t column = p / 120, row = p % 120;
    const double x = 2.0 * static_cast<double>(column) - 119.0 + 0.7 * random.normal();
    const double y = 2.0 * static_cast<double>(row) - 119.0 + 0.7 * random.normal();
    patch.positions[p] = {x - 0.15 / k * std::sin(k * x), y, 0.0};
  }
  const WakePower sums = wake_power(patch, lambda);
  const auto below =
      std::count_if(sums.bins.begin(), sums.bins.end(), [](const WakePower::Bin& bin) { return bin.power < 0.0; });
  CHECK(below > 20);
  const WakeWaves waves = wake_waves(sums);
  REQUIRE(waves.wavelength);
  CHECK(*waves.wavelength == doctest::Approx(60.0).epsilon(0.03));
  CHECK(*waves.radial_wavelength == doctest::Approx(60.0).epsilon(0.03));
  CHECK(std::fabs(*waves.angle_degrees) < 2.0);
}

} // namespace wake_spectrum_test
