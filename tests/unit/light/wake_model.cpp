#include <keeler/light/wake_model.hpp>

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace wake_model_test {

using namespace keeler;
using namespace keeler::light;

namespace {

std::vector<StarTransmission> seen(const WakeModel& model, double error, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::sample, 0);
  std::vector<StarTransmission> all;
  for (const double elevation : {6.0, 12.0, 20.0, 35.0, 60.0})
    for (int k = 0; k < 9; ++k) {
      const Bearing star{elevation * pi / 180.0, k * pi / 9.0};
      all.push_back({star, model.transmission(star) + error * random.normal(), error});
    }
  return all;
}

} // namespace

TEST_CASE("the transmission of bars") {
  const WakeModel flat{BarSection::rectangle, 0.2, 1.5, 0.1, 0.3};
  CHECK(flat.transmission({pi / 2.0, 1.0}) == doctest::Approx(0.6 * std::exp(-0.1)));
  const double b = 0.5;
  CHECK(flat.transmission({b, 0.3}) == doctest::Approx(0.6 * std::exp(-0.1 / std::sin(b)))); // along the bars
  CHECK(flat.transmission({b, 0.3 + pi / 2.0}) ==
        doctest::Approx((1.5 - 0.2 / std::tan(b)) / 2.5 * std::exp(-0.1 / std::sin(b))));
  CHECK(flat.transmission({0.05, 0.3 + pi / 2.0}) == 0.0);
  const WakeModel round{BarSection::ellipse, 0.2, 1.5, 0.1, 0.3};
  CHECK(round.transmission({pi / 2.0, 1.0}) == doctest::Approx(0.6 * std::exp(-0.1)));
  CHECK(round.transmission({b, 0.3 + pi / 2.0}) ==
        doctest::Approx((2.5 - std::hypot(1.0, 0.2 / std::tan(b))) / 2.5 * std::exp(-0.1 / std::sin(b))));
}

TEST_CASE("a fit finds the bars that made the transmissions, within its errors") {
  for (const BarSection section : {BarSection::rectangle, BarSection::ellipse})
    for (const WakeModel& model : {WakeModel{section, 0.2, 1.5, 0.12, 1.9}, WakeModel{section, 0.5, 0.8, 0.05, 0.1}}) {
      const auto exact = fit_wakes(seen(model, 1e-7, 1), section);
      REQUIRE(exact);
      CHECK(exact->model.height == doctest::Approx(model.height).epsilon(1e-3));
      CHECK(exact->model.gap == doctest::Approx(model.gap).epsilon(1e-3));
      CHECK(exact->model.gap_depth == doctest::Approx(model.gap_depth).epsilon(1e-3));
      CHECK(exact->model.azimuth == doctest::Approx(model.azimuth).epsilon(1e-3));
      double pull = 0.0, chi_square = 0.0;
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto noisy = fit_wakes(seen(model, 0.005, seed), section);
        REQUIRE(noisy);
        pull += std::pow((noisy->model.gap - model.gap) / noisy->errors.gap, 2) / 3.0;
        chi_square += noisy->chi_square / static_cast<double>(noisy->freedom) / 3.0;
      }
      CHECK(pull > 0.1);
      CHECK(pull < 3.5);
      CHECK(chi_square == doctest::Approx(1.0).epsilon(0.3));
    }
}

TEST_CASE("transmissions that leave the bars open have no fit") {
  const WakeModel model{BarSection::rectangle, 0.2, 1.5, 0.12, 1.9};
  std::vector<StarTransmission> all = seen(model, 0.01, 1);
  CHECK(!fit_wakes({all.data(), 4}, BarSection::rectangle));
  CHECK(!fit_wakes({all.data(), 9}, BarSection::rectangle)); // one elevation
  for (StarTransmission& one : all)
    one.star.azimuth = 0.3;
  CHECK(!fit_wakes(all, BarSection::rectangle));
}

} // namespace wake_model_test
