// The rows that a run records for its moonlets.
#include "moonlet_columns.hpp"

#include "scenes.hpp"
#include "unit/files/disk.hpp"

#include <keeler/files/files.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <map>

namespace moonlets_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

std::map<std::string, double> row_of(const Scene& scene, const Simulation& simulation, std::size_t k) {
  std::map<std::string, double> row;
  for (const MoonletColumn& column : moonlet_columns_of(scene))
    row[column.name] = column.value({scene, simulation, k});
  return row;
}

// One moonlet at x near the edge, so that it wraps, and one in the middle.
const std::string two = "moonlet=[{ radius = 1.5, density = 900.0, position = [14.8, 0.0, 0.0] }, "
                        "{ radius = 2.0, density = 500.0, position = [-3.0, 4.0, 0.0], velocity = [1e-4, 0.0, 2e-4] }]";

} // namespace

TEST_CASE("a moonlet's guiding centre is followed through all wraps, and its momentum is booked to who gave it") {
  const Scene scene = small_scene({two});
  Simulation simulation(scene, initial_patch(scene));
  const double kappa2 = std::pow(scene.planet.frequencies.kappa, 2), omega = scene.planet.orbital_frequency;
  const std::map<std::string, double> start = row_of(scene, simulation, 0);
  CHECK(start.at("guiding_x_m") == doctest::Approx(14.8));
  CHECK(start.at("id") == 100.0);
  CHECK(start.at("collision_momentum_kg_m_s") == 0.0);
  CHECK(start.count("force_momentum_kg_m_s") == 0);
  CHECK(row_of(scene, simulation, 1).at("inclination_m") == doctest::Approx(2e-4 / omega));
  double x = 14.8, y = 0.0;
  bool wrapped = false;
  for (int n = 0; n < 400; ++n) {
    simulation.advance();
    const std::map<std::string, double> row = row_of(scene, simulation, 0);
    const double turns = (row.at("guiding_x_m") - simulation.moonlet(0).elements.guiding_x) / scene.size_x;
    CHECK(std::fabs(turns - std::round(turns)) < 1e-12);
    wrapped = wrapped || std::round(turns) != 0.0;
    CHECK(std::fabs(row.at("guiding_x_m") - x) < 5.0); // a wrap is 30 m
    const double step = simulation.state().step_length;
    CHECK(std::fabs(row.at("guiding_y_m") - (y - 1.5 * x * step)) < 5.0);
    x = row.at("guiding_x_m"), y = row.at("guiding_y_m");
    const double all = row.at("collision_momentum_kg_m_s") + row.at("gravity_momentum_kg_m_s");
    CHECK(all == doctest::Approx(0.5 * kappa2 * omega * simulation.moonlet(0).mass * (x - start.at("guiding_x_m")))
                     .epsilon(1e-9));
  }
  CHECK(wrapped);
  CHECK(row_of(scene, simulation, 0).at("collision_momentum_kg_m_s") != 0.0);
}

// Collisions conserve momentum along the orbit: the gain of one moonlet is the loss of another body.
TEST_CASE("the momentum that collisions give a moonlet is what they take from the body it met") {
  const Scene scene = parse_scene("planet.orbital_frequency = 2e-4\nbox.size = [200.0, 60.0]\ntime.end = 1.0\n"
                                  "particles = { count = 1, density = 900.0, sizes = { law = \"equal\", radius = 0.01 "
                                  "}, seed = 7 }\n"
                                  "[[moonlet]]\nradius = 5.0\ndensity = 900.0\nposition = [20, -9, 0]\n"
                                  "[[moonlet]]\nradius = 4.0\ndensity = 300.0\nposition = [23, 9, 0]\n",
                                  "test scene");
  Simulation simulation(scene, initial_patch(scene));
  while (simulation.orbits() < 0.5)
    simulation.advance();
  REQUIRE(simulation.state().collisions.fast + simulation.state().collisions.slow > 0);
  const double first = row_of(scene, simulation, 0).at("collision_momentum_kg_m_s"),
               second = row_of(scene, simulation, 1).at("collision_momentum_kg_m_s");
  CHECK(std::fabs(first) > 0.0);
  CHECK(first == doctest::Approx(-second).epsilon(1e-6)); // except for collisions with the grain
}

TEST_CASE("an accelerated moonlet has that from the external forces") {
  const Scene scene = small_scene({two, "constant_acceleration.azimuthal=1e-8"});
  Simulation simulation(scene, initial_patch(scene));
  for (int n = 0; n < 20; ++n)
    simulation.advance();
  const double time = 20 * simulation.state().step_length / scene.planet.orbital_frequency;
  CHECK(row_of(scene, simulation, 1).at("force_momentum_kg_m_s") ==
        doctest::Approx(1e-8 * time * scene.moonlets[1].mass).epsilon(1e-12));
}

TEST_CASE("moonlets.csv has a row a moonlet for each row of the series, the same after a restart") {
  const TemporaryFolder work;
  const auto run = [&](const char* name, const std::vector<std::string>& overrides) {
    RunRequests requests;
    RunOptions options;
    options.folder = work / name;
    return start_run(small_scene(overrides), options, requests).state_hash;
  };
  const std::vector<std::string> scene = {two, "output.series_every=0.05"};
  std::vector<std::string> shorter = scene, longer = scene;
  shorter.emplace_back("time.end=0.13");
  longer.emplace_back("time.end=0.3");
  const std::string hash = run("straight", longer);
  run("resumed", shorter);
  RunRequests requests;
  RunOptions options;
  options.folder = work / "resumed";
  options.until_orbits = 0.3;
  CHECK(resume_run(options, requests).state_hash == hash);
  const std::string text = files::read_text(work / "straight" / "moonlets.csv");
  CHECK(files::read_text(work / "resumed" / "moonlets.csv") == text);
  const io::SeriesTable table = io::read_series(work / "straight" / "moonlets.csv");
  CHECK(table.rows() == 2 * io::read_series(work / "straight" / "series.csv").rows());
  CHECK(table.of("id")[2] == 100.0);
  CHECK(table.of("id")[3] == 101.0);
  run("none", {"time.end=0.1"});
  CHECK_FALSE(std::filesystem::exists(work / "none" / "moonlets.csv"));
}

TEST_CASE("docs/formats.md has the table of moonlets.csv") {
  std::string table = "| column | unit | meaning |\n|---|---|---|\n| `step` | 1 | steps done |\n";
  for (const MoonletColumn& column : moonlet_columns())
    table += std::string("| `") + column.name + "` | " + column.unit + " | " + column.meaning + " |\n";
  INFO("docs/formats.md must hold this table:\n" << table);
  CHECK(files::read_text(KEELER_SOURCE_DIR "/docs/formats.md").find(table) != std::string::npos);
}

} // namespace moonlets_test
