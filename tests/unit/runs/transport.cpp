#include <keeler/runs/transport.hpp>

#include "scenes.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/runs/run.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace transport_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

io::SeriesTable series_of(const std::vector<std::string>& overrides) {
  const TemporaryFolder work;
  RunRequests requests;
  RunOptions options;
  options.folder = work / "run";
  start_run(small_scene(overrides), options, requests);
  return io::read_series(work / "run" / "series.csv");
}

// A synthetic series: rates of 3, 2 and 1 m²/s and a loss that balances them, after a transient of two orbits.
io::SeriesTable made_up(std::size_t rows, double omega, double mass, double shear) {
  io::SeriesTable t;
  t.names = {"step",
             "time_orbits",
             "dispersion_x_m_s",
             "energy_lost_j",
             "kick_work_j",
             "random_energy_j",
             "translational_flux_kg_m2_s",
             "collisional_flux_kg_m2_s",
             "gravitational_viscosity_m2_s",
             "potential_energy_j"};
  t.columns.resize(t.names.size());
  const double s = shear * omega;
  for (std::size_t k = 0; k < rows; ++k) {
    const double orbit = 0.1 * static_cast<double>(k), time = orbit * 2.0 * pi / omega;
    const double transient = std::exp(-orbit / 0.3), noise = 0.02 * std::sin(12.9898 * static_cast<double>(k * k));
    const double values[] = {10.0 * static_cast<double>(k),
                             orbit,
                             1e-3 * (1.0 + 3.0 * transient + noise),
                             mass * s * s * (6.0 * time + 2.0 * pi / omega * (6.0 * (1.0 - transient) + 0.1 * noise)),
                             mass * s * s * time,
                             0.5 * mass,
                             3.0 * mass * s * time,
                             2.0 * mass * s * time,
                             1.0 + 20.0 * transient + noise,
                             -0.25 * mass};
    for (std::size_t c = 0; c < t.columns.size(); ++c)
      t.columns[c].push_back(values[c]);
  }
  return t;
}

} // namespace

TEST_CASE("viscosities and balance of a series that is known, after the transient that is found") {
  const double omega = 1.3e-4, mass = 5e6;
  const io::SeriesTable series = made_up(150, omega, mass, 1.5);
  const Transport t = transport(series, {mass, omega, 1.5}, {});
  CHECK(t.since_found);
  CHECK(t.since_orbit > 0.8);
  CHECK(t.since_orbit < 3.0);
  CHECK(t.steady);
  CHECK(t.translational.value == doctest::Approx(3.0).epsilon(1e-9));
  CHECK(t.collisional.value == doctest::Approx(2.0).epsilon(1e-9));
  REQUIRE(t.total);
  CHECK(t.gravitational->value == doctest::Approx(1.0).epsilon(0.03));
  CHECK(t.total->value == doctest::Approx(6.0).epsilon(0.01));
  CHECK(t.from_loss.value == doctest::Approx(6.0).epsilon(0.01));
  CHECK(std::fabs(t.balance->value - 1.0) < 0.01);

  CHECK(transport(series, {mass, omega, 1.5}, {.since = {}, .until = 6.0}).until_orbit == doctest::Approx(6.0));
  io::SeriesTable former = series; // of a version without these columns
  former.names[6] = "momentum_flux_kg_m2_s";
  CHECK(enough_rows(series));
  CHECK_FALSE(enough_rows(former));

  const Transport early = transport(series, {mass, omega, 1.5}, {.since = 0.0, .until = 3.0});
  CHECK_FALSE(early.since_found);
  CHECK_FALSE(early.steady);
  CHECK(early.until_orbit == doctest::Approx(3.0));
  CHECK_THROWS_WITH_AS(transport(series, {mass, omega, 1.5}, {.since = 99.0, .until = {}}),
                       doctest::Contains("choose a longer part"), UsageError);
}

TEST_CASE("a balance whose error is larger than it, or that is nothing over nothing, is none") {
  const auto balanced = [](const io::SeriesTable& series) {
    return transport(series, {1e6, 1.9565e-4, 1.5}, {.since = 2.0, .until = {}}).balance.has_value();
  };
  io::SeriesTable series = made_up(80, 1.9565e-4, 1e6, 1.5);
  CHECK(balanced(series));
  const auto column = [&](const std::string& name) -> std::vector<double>& {
    return series.columns[static_cast<std::size_t>(std::find(series.names.begin(), series.names.end(), name) -
                                                   series.names.begin())];
  };
  const std::vector<double> dispersions = column("dispersion_x_m_s");
  std::fill(column("dispersion_x_m_s").begin(), column("dispersion_x_m_s").end(), 0.0); // of a single particle
  CHECK(!balanced(series));
  column("dispersion_x_m_s") = dispersions;
  for (std::size_t k = 0; k < series.rows(); ++k) // a loss of either sign
    column("energy_lost_j")[k] = std::sin(12.9898 * static_cast<double>(k * k));
  CHECK(!balanced(series));
  for (const std::string name : {"energy_lost_j", "kick_work_j", "random_energy_j", "translational_flux_kg_m2_s",
                                 "collisional_flux_kg_m2_s", "gravitational_viscosity_m2_s", "potential_energy_j"})
    std::fill(column(name).begin(), column(name).end(), 0.0);
  CHECK(!balanced(series));
}

TEST_CASE("waves that grow are told, and do not make a steady ring unsteady") {
  const double omega = 1.3e-4, mass = 5e6;
  io::SeriesTable series = made_up(150, omega, mass, 1.5);
  const RingScale scale{mass, omega, 1.5};
  CHECK_FALSE(transport(series, scale, {}).waves); // of a version that did not measure them
  const std::vector<double> orbits = series.of("time_orbits"), random = series.of("dispersion_x_m_s");
  // c_x of the whole motion grows with the waves, that of the random motion stays
  std::vector<double> fractions, whole;
  for (std::size_t k = 0; k < orbits.size(); ++k) {
    fractions.push_back(0.04 + 0.02 * orbits[k]);
    whole.push_back(random[k] / std::sqrt(1.0 - fractions[k]));
  }
  series.columns[2] = whole;
  CHECK_FALSE(transport(series, scale, {}).steady); // as with c_x of the whole motion
  series.names.insert(series.names.end(), {"epicyclic_wave_fraction", "dispersion_without_waves_x_m_s"});
  series.columns.push_back(fractions);
  series.columns.push_back(random);
  const Transport grown = transport(series, scale, {.since = 4.0, .until = 12.0});
  REQUIRE(grown.waves);
  CHECK(grown.steady);
  CHECK_FALSE(grown.waves->steady);
  CHECK(grown.waves->first_half.value == doctest::Approx(0.16).epsilon(0.01));
  CHECK(grown.waves->last_half.value == doctest::Approx(0.24).epsilon(0.01));

  std::vector<double>& column = series.columns[series.columns.size() - 2];
  for (std::size_t k = 0; k < column.size(); ++k)
    column[k] = 0.1 + 0.02 * std::sin(7.0 * static_cast<double>(k));
  CHECK(transport(series, scale, {}).waves->steady);
  for (double& fraction : column)
    fraction = std::nan(""); // few particles
  series.columns.back() = column;
  const Transport few = transport(series, scale, {});
  CHECK_FALSE(few.waves);
  CHECK(few.since_found);
}

TEST_CASE("gravity's energy and stress are in the rows that are due, and a scene without gravity has none") {
  const io::SeriesTable with = series_of({"time.end=0.4", "output.series_every=0.02", "output.stress_every=0.1"});
  const std::vector<double>& potential = with.of("potential_energy_j");
  CHECK(std::count_if(potential.begin(), potential.end(), [](double v) { return std::isfinite(v); }) == 5);
  CHECK(std::isfinite(potential.front()));
  const io::SeriesTable without = series_of({"time.end=0.4", "output.stress_every=0"});
  CHECK(without.find("potential_energy_j") == nullptr);
  const Transport t = transport(without, {1.0, 1.9565e-4, 1.5}, {.since = 0.0, .until = {}});
  CHECK_FALSE(t.gravitational); // there was gravity, but its stress was not measured
  CHECK_FALSE(t.balance);
}

TEST_CASE("a common drift in a head wind is no viscosity, and a ring without self-gravity has a total one") {
  const TemporaryFolder work;
  RunRequests requests;
  RunOptions options;
  options.folder = work / "run";
  const Scene scene = parse_scene(R"(
planet = { orbital_frequency = 1.9565e-4 }
box.size = [30.0, 25.0]
particles = { count = 100, density = 500.0, sizes = { law = "equal", radius = 1.0 } }
gas = { stopping_time = 0.5, head_wind = 2e-3 }
time = { step = 5e-3, end = 8.0 }
output = { series_every = 0.05 }
)",
                                  "test scene");
  start_run(scene, options, requests);
  const io::SeriesTable series = io::read_series(work / "run" / "series.csv");
  const std::vector<double>&orbits = series.of("time_orbits"), &random = series.of("translational_viscosity_m2_s"),
        &drift = series.of("drift_viscosity_m2_s");
  double of_random = 0.0, of_drift = 0.0, rows = 0.0;
  for (std::size_t k = 0; k < orbits.size(); ++k)
    if (orbits[k] >= 4.0)
      of_random += random[k], of_drift += drift[k], rows += 1.0;
  of_random /= rows, of_drift /= rows;
  // the terminal velocity in the head wind w: c_y = −w/(1 + κ²τ²), c_x = 2τ c_y
  const double tau = two_pi * 0.5, c_y = -2e-3 / (1.0 + tau * tau);
  CHECK(of_drift == doctest::Approx(2.0 * tau * c_y * c_y / (1.5 * 1.9565e-4)).epsilon(0.02));
  CHECK(of_drift > 5.0 * std::fabs(of_random));
  const double mass = 100 * 4.0 / 3.0 * pi * 500.0;
  const Transport t = transport(series, {mass, 1.9565e-4, 1.5, true, false}, {.since = 4.0, .until = {}});
  CAPTURE(of_random);
  CHECK(std::fabs(t.translational.value - of_random) < 0.1 * std::fabs(of_random) + 0.003 * of_drift);
  REQUIRE(t.total);
  CHECK(t.gravitational->value == 0.0);
  CHECK(t.total->value == doctest::Approx(t.translational.value + t.collisional.value).epsilon(1e-9));
  CHECK_FALSE(t.balance); // the gas takes energy
}

} // namespace transport_test
