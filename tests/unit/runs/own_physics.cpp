// Apart from the other tests, whose scenes have no physics of a calling program.
#include "own_physics.hpp"
#include "scenes.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/scene/keys.hpp>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace own_physics_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

const std::string one_particle = R"(
planet.orbital_frequency = 2e-4
box.size = [1000.0, 1000.0]
particles.count = 1
particles.density = 900.0
particles.sizes = { law = "equal", radius = 1.0 }
particles.start = { law = "lattice", eccentricity = 20.0 }
gas_drag.rate = 0.5
time = { step = 1e-3, end = 1.0 }
)";

Scene dragged(const std::vector<std::string>& more = {}) {
  return small_scene(quantities::joined({"gas_drag.rate=0.3", "output.series_every=0.1"}, more));
}

// Starts the run of a folder, or continues it, until an orbit.
RunResult run(const std::filesystem::path& folder, const std::vector<std::string>& more, double until) {
  RunRequests requests;
  RunOptions options;
  options.folder = folder;
  options.until_orbits = until;
  const bool begun = std::filesystem::exists(folder);
  return begun ? resume_run(options, requests)
               : start_run(dragged(quantities::joined(more, {"time.end=" + std::to_string(until)})), options, requests);
}

template<class Call> std::string fault_of(const Call& call) {
  try {
    call();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no fault";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

} // namespace

TEST_CASE("an own force acts as its formula says, and its work is booked under its name") {
  add_own_physics();
  const Scene scene = parse_scene(one_particle, "test scene");
  Simulation simulation(scene, initial_patch(scene));
  while (simulation.orbits() < 1.0 - 1e-9)
    simulation.advance();
  const Body& body = simulation.state().particles.bodies[0];
  CHECK(body.elements.eccentricity() == doctest::Approx(20.0 * std::exp(-0.5)).epsilon(1e-3));
  const simulation::SimulationState& state = simulation.state();
  REQUIRE(state.forces.size() == 1);
  CHECK(state.forces[0].name == "gas_drag");
  CHECK(state.forces[0].work < 0.0);
  CHECK(state.kick_work() == state.forces[0].work);
  CHECK(std::fabs(simulation.balance().residual) < 1e-11 * std::fabs(state.forces[0].work));
  CHECK(simulation.time_split().force("gas_drag") > 0.0);
}

TEST_CASE("a run with an own force goes on from its checkpoint bit for bit, beside self-gravity and collisions") {
  add_own_physics();
  const TemporaryFolder work;
  for (const char* every : {"gravity.kick_every=1", "gravity.kick_every=4"}) {
    CAPTURE(every);
    const std::filesystem::path half = work / (std::string("half") + every), whole = work / (std::string("w") + every);
    run(half, {every}, 0.2);
    CHECK(run(half, {every}, 0.4).state_hash == run(whole, {every}, 0.4).state_hash);
    CHECK(files::read_text(half / "series.csv") == files::read_text(whole / "series.csv"));
    const simulation::SimulationState resumed = load_newest_checkpoint(half, {}).state,
                                      straight = load_newest_checkpoint(whole, {}).state;
    CHECK(resumed.forces[1].work == straight.forces[1].work);
    CHECK(resumed.forces[1].azimuthal_gain == straight.forces[1].azimuthal_gain);
  }
}

TEST_CASE("the keys of own physics are checked, listed and stored as all others, and those of a force are hashed") {
  add_own_physics();
  const std::string listed = scene::describe_keys(false);
  for (const char* key :
       {"gas_drag.rate", "particles.sizes.lowest", "particles.start.law", "particles.start.eccentricity"})
    CHECK(has(listed, key));
  CHECK(has(fault_of([] { dragged({"gas_drag.raet=1"}); }), "did you mean \"rate\"?"));
  CHECK(has(fault_of([] { dragged({"gas_drag.rate=-1"}); }), "gas_drag.rate is -1, but must be a number from 0 to 10"));
  CHECK(has(fault_of([] { dragged({"gas_drag.rate=9"}); }), ": the gas is too dense"));
  const Scene scene = dragged();
  CHECK(has(scene.resolved, "[gas_drag]\nrate = 0.3\n"));
  CHECK(has(scene.motion, "gas_drag.rate = 0.3\n"));
  const Simulation simulation(scene, initial_patch(scene));
  const std::string hash = state_hash(simulation.state(), scene);
  CHECK(hash != state_hash(simulation.state(), dragged({"gas_drag.rate=0.2"})));
  const Scene again = scene::parse_stored_scene(scene.resolved, "stored");
  CHECK(hash == state_hash(simulation.state(), again));
  CHECK_FALSE(has(parse_scene(one_particle, "test scene").motion, "particles.start"));
}

TEST_CASE("a force that misses the kicks at which a run stops is refused") {
  add_own_physics();
  const Scene scene = dragged({"gravity.kick_every=4", "gas_drag.every=3"});
  const Patch patch = initial_patch(scene);
  CHECK(has(fault_of([&] { Simulation(scene, patch); }), "'gas_drag' kicks every 3 steps"));
}

TEST_CASE("an own size law has the moments that it names, and a scene draws its particles from it") {
  add_own_physics();
  const Scene scene = parse_scene(R"(
planet.orbital_frequency = 2e-4
box.size = [400.0, 400.0]
particles = { optical_depth = 0.5, density = 900.0, sizes = { law = "uniform", lowest = 0.5, highest = 2.0 } }
time.end = 1.0
)",
                                  "test scene");
  const particles::SizeLaw& law = scene.particles.sizes;
  const std::vector<double> radii = draw_radii(law, 20000, 1);
  for (const int k : {1, 2, 3, 6}) {
    const double mean = std::accumulate(radii.begin(), radii.end(), 0.0,
                                        [&](double sum, double r) { return sum + std::pow(r, k) / 20000.0; });
    CHECK(mean == doctest::Approx(law.mean_power(k)).epsilon(1e-3));
  }
  CHECK(scene.optical_depth() == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(has(scene.resolved, "[particles.sizes]\nlaw = \"uniform\"\nlowest = 0.5\nhighest = 2.0\n"));
  CHECK_FALSE(has(scene.motion, "lowest"));
  const Patch patch = initial_patch(scene);
  CHECK(patch.radii == draw_radii(law, patch.size(), scene.particles.seed));
  particles::SizeLaw wrong = law;
  wrong.mean_power = [](int) { return 100.0; };
  CHECK(has(fault_of([&] { require_consistent(wrong); }), "the root of the mean power 1 is 100 m"));
}

TEST_CASE("an own start places each particle, and moonlets come after them") {
  add_own_physics();
  const std::string text = R"(
planet.orbital_frequency = 2e-4
box.size = [90.0, 60.0]
particles.count = 30
particles.density = 900.0
particles.sizes = { law = "equal", radius = 1.0 }
particles.start = { law = "lattice", eccentricity = 2.0 }
time.end = 1.0
)";
  const Scene scene =
      parse_scene(text + "[[moonlet]]\nradius = 4.0\ndensity = 900.0\nposition = [0.0, 0.0, 20.0]\n", "test scene");
  const Patch patch = initial_patch(scene);
  REQUIRE(patch.size() == 31);
  CHECK(patch.radii[30] == 4.0);
  CHECK(patch.ids[30] == 30);
  CHECK(patch.masses[0] == doctest::Approx(900.0 * 4.0 / 3.0 * pi));
  const Particles particles = particles_from(patch, 0.0);
  for (std::size_t k = 0; k < 30; ++k)
    CHECK(particles.bodies[k].elements.eccentricity() == doctest::Approx(2.0));
  Simulation simulation(scene, patch);
  for (int k = 0; k < 10; ++k)
    simulation.advance();
  CHECK(simulation.first_moonlet() == 30);

  const auto with = [&](const std::string& more) {
    return [&text, more] { initial_patch(parse_scene(text + more, "test scene")); };
  };
  CHECK(has(fault_of(with("particles.modes.outward = [[1, 0.1, 0.0]]\n")), "cannot be combined with particles.start"));
  CHECK(has(fault_of(with("start.from = \"snap.hdf\"\n")), "cannot be combined with start.from"));
  const auto varied = [&](const char* change) {
    return [&text, change] { initial_patch(parse_scene(text, "test scene", {change})); };
  };
  CHECK(has(fault_of(varied("particles.start.missing=2")),
            "the start 'lattice' places 28 particles, but the scene has 30"));
  CHECK(has(fault_of(varied("particles.start.shift=80")), "the start 'lattice' gives particle 1 x = "));
}

TEST_CASE("an own column is in series.csv, and an own quantity in what analyze prints") {
  add_own_physics();
  const TemporaryFolder work;
  run(work / "run", {}, 0.2);
  const io::SeriesTable series = io::read_series(work / "run" / "series.csv");
  CHECK(series.names.back() == "gas_work_j");
  CHECK(series.of("gas_work_j").front() == 0.0);
  CHECK(series.of("gas_work_j").back() < 0.0);
  run(work / "plain", {"gas_drag.rate=0"}, 0.1); // the column is only in scenes with gas
  CHECK(io::read_series(work / "plain" / "series.csv").find("gas_work_j") == nullptr);

  const auto json = nlohmann::json::parse(analyze_json(work / "run"));
  const Patch last = load_newest_patch(work / "run").patches.front();
  const auto of_last = nlohmann::json::parse(analyze_json(snapshots_in(work / "run").back()));
  CHECK(of_last["mean_height_m"] == doctest::Approx(mean_height(last)));
  CHECK(json["mean_height_m"].is_number());
  CHECK(find_quantity(measured_quantities(), "mean_height_m")->meaning == "mean of |z|");
  CHECK(find_quantity(series_quantities(), "gas_work_j") != nullptr);
}

TEST_CASE("a name that is taken is refused") {
  add_own_physics();
  CHECK(fault_of([] { add_force(gas_drag("satellite")); }) ==
        "there is a force 'satellite' already; give this force another name");
  CHECK(has(fault_of([] { add_force(gas_drag("gas_drag")); }), "there is a force 'gas_drag' already"));
  CHECK(has(fault_of([] { add_force(gas_drag("Gas")); }), "cannot be called 'Gas'"));
  const auto refused = [](const std::string& name) {
    const std::string fault = fault_of([&] { add_force(gas_drag(name.c_str())); });
    return has(fault, "cannot be called '" + name + "' (scenes and runs use") || has(fault, "already");
  };
  for (const config::Section& section : scene::scene_sections())
    CHECK(refused(section.path.substr(0, section.path.find('.'))));
  for (const Key& key : scene::scene_keys())
    CHECK((!key.section().empty() || refused(key.path)));
  CHECK(has(fault_of([] {
              forces::add_force({"bare", {}, [](const Parameters&, const forces::ForceContext&) {
                                   return std::unique_ptr<forces::Force>();
                                 }});
            }),
            "the force 'bare' has no keys"));

  CHECK(has(fault_of([] { particles::add_size_law({"power", {}, nullptr}); }), "there is a size law 'power' already"));
  CHECK(has(fault_of([] {
              particles::add_size_law({"own", {{.path = "min", .example = "1"}}, nullptr});
            }),
            "the key 'min' of the size law 'own' is in its table already"));
  CHECK(has(fault_of([] { particles::add_start({"lattice", {}, nullptr}); }), "there is a start 'lattice' already"));
  CHECK(has(fault_of([] {
              add_series_column({"collisions", "1", "", "", nullptr});
            }),
            "there is a column 'collisions'"));
  CHECK(has(fault_of([] { add_series_column({"step", "1", "", "", nullptr}); }), "there is a column 'step'"));
  for (const char* name : {"mean_height_m", "toomre_q", "total_viscosity_m2_s", "clusters"})
    CHECK(has(fault_of([&] { add_quantity({name, "", "", "", nullptr}); }), "there is a quantity"));
}

TEST_CASE(
    "a force that is added after scenes were read is in the next ones, and a replaced one stays in those before") {
  add_own_physics();
  const Scene before = dragged();
  CHECK(has(fault_of([] { dragged({"late.rate=0.2"}); }), "unknown table late"));
  add_force(gas_drag("late"));
  const Scene late = dragged({"late.rate=0.2"});
  REQUIRE(late.external_forces.size() == 2);
  CHECK(dragged().resolved == before.resolved);

  const auto speed_after = [](const Scene& scene) {
    Simulation simulation(scene, initial_patch(scene));
    simulation.advance();
    return simulation.state().forces[1].accelerations[0].norm();
  };
  const double old = speed_after(late);
  forces::ForceEntry twice = gas_drag("late");
  twice.make = [](const Parameters& p, const forces::ForceContext&) -> std::unique_ptr<forces::Force> {
    return std::make_unique<GasDrag>(2.0 * p.number("rate") / two_pi, p.integer("every"));
  };
  CHECK(has(fault_of([&] { forces::add_force(twice); }), "there is a force 'late' already"));
  forces::add_force(twice, IfTaken::replace);
  CHECK(speed_after(late) == old);
  CHECK(speed_after(dragged({"late.rate=0.2"})) == doctest::Approx(2.0 * old).epsilon(0.05));
}

} // namespace own_physics_test
