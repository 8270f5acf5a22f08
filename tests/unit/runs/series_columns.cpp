#include <keeler/runs/series_columns.hpp>

#include "scenes.hpp"

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/viscosity.hpp>
#include <keeler/files/files.hpp>
#include <keeler/initial_conditions/initial.hpp>

#include <doctest/doctest.h>

#include <map>
#include <set>

namespace series_columns_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

std::map<std::string, double> row_of(const Scene& scene, const Simulation& simulation) {
  const std::vector<SeriesColumn> columns = series_columns_of(scene);
  const std::vector<std::string> names = names_of(columns);
  const std::vector<double> values = values_of(columns, SeriesSample(scene, simulation));
  REQUIRE(names.size() == values.size());
  std::map<std::string, double> row;
  for (std::size_t k = 0; k < names.size(); ++k)
    row[names[k]] = values[k];
  return row;
}

std::string markdown_row(const SeriesColumn& column) {
  return std::string("| `") + column.name + "` | " + column.unit + " | " + column.meaning + " |\n";
}

} // namespace

TEST_CASE("a row is what the patch says, measured particle by particle") {
  const Scene scene = small_scene();
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < 40; ++k)
    simulation.advance();
  std::map<std::string, double> row = row_of(scene, simulation);
  const Patch patch = simulation.patch();
  const double omega = patch.orbital_frequency, joule = omega * omega;
  const Vec3 c = diagnostics::velocity_si(patch, diagnostics::velocity_dispersion(patch));
  CHECK(row["time_orbits"] == simulation.orbits());
  CHECK(row["dispersion_x_m_s"] == doctest::Approx(c.x()).epsilon(1e-12));
  CHECK(row["dispersion_y_m_s"] == doctest::Approx(c.y()).epsilon(1e-12));
  CHECK(row["dispersion_z_m_s"] == doctest::Approx(c.z()).epsilon(1e-12));
  CHECK(row["scale_height_m"] == doctest::Approx(diagnostics::scale_height(patch)).epsilon(1e-12));
  const diagnostics::EpicyclicWaves waves = diagnostics::epicyclic_waves(patch).value();
  const double bins =
      0.06 / std::sqrt(static_cast<double>(patch.size())); // of the guiding radius: few particles in each
  CHECK(std::fabs(row["epicyclic_wave_fraction"] - waves.energy) < bins);
  CHECK(row["dispersion_without_waves_x_m_s"] == doctest::Approx(waves.residual_dispersion(c).x()).epsilon(bins));

  const simulation::SimulationState& state = simulation.state();
  CHECK(state.collisions.fast > 0);
  CHECK(row["collisions"] == static_cast<double>(state.collisions.fast));
  CHECK(row["slow_contacts"] == static_cast<double>(state.collisions.slow));
  CHECK(row["collisional_flux_kg_m2_s"] == state.collisions.momentum_flux * omega);
  CHECK(row["translational_viscosity_m2_s"] ==
        doctest::Approx(diagnostics::translational_viscosity(patch) * omega).epsilon(1e-12));
  // the energy of the random motions is the Cartesian sum, and its change is the accounted work
  double now = 0.0;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double height = patch.frequencies.nu * patch.positions[k].z();
    now += 0.5 * patch.masses[k] * (diagnostics::peculiar_velocity(patch, k).squaredNorm() + height * height) * joule;
  }
  CHECK(row["random_energy_j"] == doctest::Approx(now).epsilon(1e-12));
  const double work =
      patch.frequencies.shear() * omega * (row["translational_flux_kg_m2_s"] + row["collisional_flux_kg_m2_s"]);
  const double booked = row["kick_work_j"] + work - row["energy_lost_j"];
  CHECK(std::fabs(now - simulation.balance().start * joule - booked) < 1e-10 * now);
  CHECK(std::fabs(row["energy_residual_j"]) < 1e-12 * now);
  CHECK(row["energy_lost_j"] > 0.0);
}

TEST_CASE("the largest overlap is a column only where particles can overlap") {
  const Scene exact = small_scene();
  const Simulation simulation(exact, initial_patch(exact));
  CHECK(row_of(exact, simulation).count("largest_overlap") == 0);

  const Scene scene = small_scene({"collisions.finder=linear-full"}); // may miss contacts
  simulation::SimulationState state = simulation.state();
  Body &first = state.particles.bodies[0], &second = state.particles.bodies[1];
  second.elements = first.elements;
  second.elements.guiding_x += 0.5 * (first.radius + second.radius);
  CHECK(row_of(scene, Simulation(scene, state)).at("largest_overlap") == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("every column has a name of its own and says what it is; docs/formats.md has the table") {
  std::set<std::string> names;
  std::string table = "| column | unit | meaning |\n|---|---|---|\n| `step` | 1 | steps done |\n";
  for (const SeriesColumn& column : series_columns()) {
    const std::string name = column.name;
    CAPTURE(name);
    CHECK(names.insert(name).second);
    CHECK(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == name.npos);
    table += markdown_row(column);
  }
  const std::string page = files::read_text(KEELER_SOURCE_DIR "/docs/formats.md");
  INFO("docs/formats.md must hold this table:\n" << table);
  CHECK(page.find(table) != page.npos);
}

} // namespace series_columns_test
