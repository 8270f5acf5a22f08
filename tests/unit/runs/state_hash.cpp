#include <keeler/runs/state_hash.hpp>

#include "moonlet_columns.hpp"
#include "scenes.hpp"

#include <keeler/initial_conditions/initial.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <keeler/core/field_table.hpp>
#include <keeler/scene/keys.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace state_hash_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

simulation::SimulationState evolved(const Scene& scene, int steps) {
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < steps; ++k)
    simulation.advance();
  return simulation.state();
}

} // namespace

TEST_CASE("the hash sees the state and the physics, not memory order, schedules or counters") {
  const Scene scene = small_scene();
  const simulation::SimulationState state = evolved(scene, 5);
  const std::string hash = state_hash(state, scene);
  CHECK(hash.size() == 32);

  simulation::SimulationState reversed = state;
  std::reverse(reversed.particles.bodies.begin(), reversed.particles.bodies.end());
  std::reverse(reversed.particles.ids.begin(), reversed.particles.ids.end());
  reversed.collisions.fast += 7;
  Scene later = scene;
  later.time.end_step *= 2;
  later.output.snapshot_every += 1;
  later.title = "another";
  CHECK(state_hash(reversed, later) == hash);

  simulation::SimulationState moved = state;
  moved.particles.bodies[3].elements.e_cos = std::nextafter(moved.particles.bodies[3].elements.e_cos, 1.0);
  CHECK(state_hash(moved, scene) != hash);
  simulation::SimulationState stepped = state;
  ++stepped.step;
  CHECK(state_hash(stepped, scene) != hash);
}

TEST_CASE("the hash sees each key that has a say in the motion, and no other") {
  // every key that the other test scene leaves at its default has another value here
  using enum KeyEffect;
  const std::map<std::string, std::pair<std::string, KeyEffect>> others = {
      {"title", {"other", output}},
      {"planet.orbital_frequency", {"1.9e-4", motion}},
      {"planet.epicyclic_ratio", {"0.99", motion}},
      {"planet.vertical_ratio", {"1.01", motion}},
      {"box.size", {"[31.0, 30.0]", start}},
      {"particles.count", {"99", start}},
      {"particles.density", {"600.0", start}},
      {"particles.velocity_dispersion", {"2.5", start}},
      {"particles.seed", {"2", motion}},
      {"particles.sizes.exponent", {"2.0", start}},
      {"particles.sizes.min", {"0.4", start}},
      {"particles.sizes.max", {"1.5", start}},
      {"collisions.finder", {"linear-full", motion}},
      {"collisions.elastic_below_speed", {"2e-2", motion}},
      {"collisions.restitution.scale", {"0.32", motion}},
      {"collisions.restitution.max_coefficient", {"0.9", motion}},
      {"collisions.friction.tangential_restitution", {"0.5", motion}},
      {"collisions.friction.coefficient", {"0.2", motion}},
      {"gravity.solver", {"direct", motion}},
      {"gravity.opening_angle", {"0.5", motion}},
      {"gravity.images", {"rings", motion}},
      {"gravity.image_rings", {"2", motion}},
      {"gravity.kick_every", {"2", motion}},
      {"gravity.resting_contacts", {"carried", motion}},
      {"constant_acceleration.radial", {"1e-9", motion}},
      {"constant_acceleration.azimuthal", {"1e-9", motion}},
      {"constant_acceleration.vertical", {"1e-9", motion}},
      {"gas.stopping_time", {"0.2", motion}},
      {"gas.head_wind", {"1.0", motion}},
      {"gas.radius", {"1.0", motion}},
      {"time.step", {"2e-3", motion}},
      {"time.end", {"2.0", output}},
      {"output.snapshot_every", {"0.25", output}},
      {"output.checkpoint_every", {"0.25", output}},
      {"output.checkpoint_every_minutes", {"5.0", output}},
      {"output.series_every", {"0.05", output}},
      {"output.stress_every", {"0.2", output}},
      {"output.collisions.min_speed", {"1e-4", output}},
      {"output.collisions.min_radius_sum", {"1.0", output}},
      {"output.collisions.fraction", {"0.5", output}},
      {"output.collisions.at_rest", {"logged", output}},
  };
  const std::set<std::string> needless = {"quality", // it says other keys
                                          "planet.preset",
                                          "box.size_in_wavelengths",
                                          "particles.optical_depth",
                                          "particles.surface_density",
                                          "particles.sizes.law",
                                          "particles.sizes.radius",
                                          "particles.sizes.path",
                                          "particles.sizes.table",
                                          "particles.sizes.populations",
                                          "collisions.restitution.law",
                                          "collisions.restitution.value",
                                          "collisions.restitution.table",
                                          "collisions.restitution.critical_speed",
                                          "collisions.restitution.name",
                                          "collisions.restitution.reference_speed",
                                          "collisions.restitution.reference_radius",
                                          "gravity.force_error",
                                          "gravity.mesh_spacing",
                                          "gravity.shortest_wavelength",
                                          "start.from",
                                          "start.keep_fraction",
                                          "start.keep_seed"};
  const Scene scene = small_scene();
  const simulation::SimulationState state = evolved(scene, 2);
  const std::string hash = state_hash(state, scene);
  std::size_t seen = 0;
  for (const Key& key : scene::scene_keys()) {
    const auto other = others.find(key.path);
    if (other == others.end()) { // cannot be combined with the other keys of this scene
      CHECK((needless.count(key.path) == 1 || key.section() == "particles.streamlines" ||
             key.section() == "particles.modes" || key.section() == "particles.density_step" ||
             key.section() == "particles.wake" || key.section() == "particles.aggregate" ||
             key.section() == "moonlet" || key.section() == "satellite"));
      CHECK((key.effect == motion || key.section() != "satellite"));
      CHECK((key.effect == start || (key.section() != "moonlet" && key.section() != "particles.aggregate")));
      continue;
    }
    ++seen;
    CAPTURE(key.path);
    const auto& [value, effect] = other->second;
    CHECK(key.effect == effect);
    std::vector<std::string> overrides = {key.path + "=" + value};
    if (key.path == "collisions.friction.coefficient")
      overrides.push_back("collisions.friction.tangential_restitution=0.4");
    if (key.section() == "gas" && key.name() != "stopping_time")
      overrides.push_back("gas.stopping_time=0.1");
    const Scene changed = small_scene(overrides);
    CHECK((state_hash(state, changed) != hash) == (effect == motion));
  }
  CHECK(seen == others.size());
}

TEST_CASE("the hash sees the spins of rough particles") {
  const Scene scene = small_scene({"collisions.friction.tangential_restitution=0.5"});
  simulation::SimulationState state = evolved(scene, 5);
  REQUIRE(state.particles.spins.size() == 100);
  const std::string hash = state_hash(state, scene);
  state.particles.spins[7].x() = std::nextafter(state.particles.spins[7].x(), 9.0);
  CHECK(state_hash(state, scene) != hash);
}

TEST_CASE("the hash sees a satellite and its mass") {
  const auto hash_of = [](const std::string& satellite) {
    const Scene scene = small_scene({"satellite=" + satellite});
    return state_hash(simulation::SimulationState(scene), scene);
  };
  CHECK(hash_of("{ mass = 1e9, distance = 300, passage = 1 }") !=
        hash_of("{ mass = 2e9, distance = 300, passage = 1 }"));
  CHECK(hash_of("{ mass = 1e9, distance = 300, passage = 1 }") ==
        hash_of("{ mass = 1e9, distance = 300, passage = 1, every = 0 }"));
}

TEST_CASE("the hash sees the rows of a table of restitution, not the file that they came from") {
  const auto folder = std::filesystem::temp_directory_path() / "keeler_test_state_hash";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.txt") << "# m/s  coefficient\n0.01 0.5\n0.1, 0.25\n";
  const auto hash_of = [&](const std::string& table) {
    const Scene scene = small_scene({"collisions.restitution={law=\"table\", table=" + table + "}"});
    return state_hash(simulation::SimulationState(scene), scene);
  };
  const std::string hash = hash_of("[[0.01, 0.5], [0.1, 0.25]]");
  CHECK(hash_of("\"" + (folder / "a.txt").string() + "\"") == hash);
  CHECK(hash_of("[[0.01, 0.5], [0.1, 0.24]]") != hash);
  const Scene from_file =
      small_scene({"collisions.restitution={law=\"table\", table=\"" + (folder / "a.txt").string() + "\"}"});
  std::filesystem::remove_all(folder);
  const Scene stored = scene::parse_stored_scene(from_file.resolved, "stored"); // goes on without the file
  CHECK(stored.collisions.restitution({.speed = 0.1}) == 0.25);
  CHECK(stored.motion == from_file.motion);
}

TEST_CASE("the field table holds all that a run needs to go on to the bit") {
  Scene scene = small_scene();
  SUBCASE("smooth particles") {}
  SUBCASE("rough particles") {
    scene = small_scene({"collisions.friction.tangential_restitution=0.5"});
  }
  SUBCASE("moonlets, an external force and a sparse kick") {
    scene = small_scene({"moonlet=[{ radius = 1.5, density = 900.0, position = [14.8, 0.0, 0.0] }]",
                         "constant_acceleration.azimuthal=1e-9", "gravity.kick_every=5"});
  }
  SUBCASE("an automatic step, from wakes that have changed it") {
    scene = small_scene({"time.step=\"auto\"", "collisions.elastic_below_speed=0.3", "output.series_every=0.0625"});
  }
  const std::int64_t half_way = scene.time.automatic ? 700 : 10; // steps
  const auto steps = [](Simulation& simulation, std::int64_t count) {
    for (std::int64_t k = 0; k < count; ++k)
      simulation.advance();
  };
  Simulation straight(scene, initial_patch(scene));
  steps(straight, half_way);
  simulation::SimulationState half = straight.state();
  simulation::SimulationState restored(scene); // filled through the table alone, as a checkpoint is read
  FieldTable from = half.fields(), into = restored.fields();
  for (std::size_t k = 0; k < from.fields().size(); ++k) {
    const Field &source = from.fields()[k], &target = into.fields()[k];
    target.resize(source.rows());
    std::copy_n(static_cast<const char*>(source.data()), source.bytes(), static_cast<char*>(target.data()));
  }
  REQUIRE(half.fault(scene).empty());
  REQUIRE(restored.fault(scene).empty());
  Simulation resumed(scene, restored);
  steps(resumed, 10);
  steps(straight, 10);
  CHECK(state_hash(resumed.state(), scene) == state_hash(straight.state(), scene));
  CHECK(resumed.state().control.steps == straight.state().control.steps);
  // the energy budget too
  const std::vector<double> row = values_of(series_columns(), SeriesSample(scene, straight)),
                            again = values_of(series_columns(), SeriesSample(scene, resumed));
  for (std::size_t c = 0; c < row.size(); ++c) {
    CAPTURE(series_columns()[c].name);
    CHECK((row[c] == again[c] || (std::isnan(row[c]) && std::isnan(again[c]))));
  }
  for (std::size_t k = 0; k < straight.state().moonlets.size(); ++k)
    for (const MoonletColumn& column : moonlet_columns_of(scene)) {
      CAPTURE(column.name);
      CHECK(column.value({scene, straight, k}) == column.value({scene, resumed, k}));
    }
}

} // namespace state_hash_test
