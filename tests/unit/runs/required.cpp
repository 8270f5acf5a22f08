// A disabled option uses no memory, makes no object and does no work. Memory is counted by the program's allocations,
// work by its counters: a stopwatch that never ran reads 0.
#include "counted_heap.hpp"
#include "recorder.hpp"

#include "unit/files/disk.hpp"

#include <keeler/collision/costs.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace required_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

// Optical depth 1, and nothing that can be left out.
Scene bare_scene(std::size_t count, const std::vector<std::string>& more = {}) {
  const double side = std::sqrt(pi * static_cast<double>(count));
  return parse_scene(fmt::format("planet.orbital_frequency = 1.9565e-4\n"
                                 "box.size = [{0}, {0}]\n"
                                 "particles = {{ count = {1}, density = 900.0, sizes = {{ law = \"equal\", radius = "
                                 "1.0 }} }}\n"
                                 "time = {{ step = 1e-2, end = 0.1 }}\n"
                                 "output = {{ series_every = 0, checkpoint_every_minutes = 0 }}\n",
                                 side, count),
                     "test scene", more);
}

// After some steps.
struct Held {
  std::size_t particles = 0;
  double all = 0.0;     // bytes per particle of the simulation
  double drift = 0.0;   // part of it reported by the drift, including the particles
  double at_kick = 0.0; // of all, what stays while forces are computed
  simulation::TimeSplit split;
  std::size_t forces = 0;
};

Held held_by(const Scene& scene, collision::DriftObserver* observer = nullptr) {
  const Patch start = initial_patch(scene);
  const std::int64_t before = bytes_held;
  Simulation simulation(scene, start);
  simulation.drift().observe(observer);
  for (int k = 0; k < 15; ++k)
    simulation.advance();
  const auto per_particle = [&] {
    return static_cast<double>(bytes_held - before) / static_cast<double>(start.size());
  };
  Held held;
  held.particles = start.size();
  held.all = per_particle();
  held.drift = static_cast<double>(simulation.drift().costs().bytes_per_particle);
  simulation.drift().release_contacts();
  held.at_kick = per_particle();
  held.split = simulation.time_split();
  held.forces = simulation.state().forces.capacity();
  return held;
}

struct TakesRecords final : collision::DriftObserver {
  std::size_t count = 0;
  bool wants_events() const override { return false; }
  bool wants_records() const override { return true; }
  void recorded(std::span<const collision::CollisionRecord> records) override { count += records.size(); }
};

constexpr std::size_t many = 20000;
constexpr double tolerance = 2.0; // bytes per particle: parts that do not grow with their number, and rounding

} // namespace

TEST_CASE("a scene that asks for nothing more holds what the drift tells, and nothing else") {
  set_threads(1);
  const Held bare = held_by(bare_scene(many));
  CAPTURE(bare.all);
  CAPTURE(bare.drift);
  CHECK(std::fabs(bare.all - bare.drift) < tolerance);
  CHECK(bare.forces == 0);
  CHECK(bare.split.forces.empty());
  CHECK(bare.split.kick == 0.0);
}

TEST_CASE("a force holds one acceleration a particle, which a scene without it does not") {
  set_threads(1);
  const Held bare = held_by(bare_scene(many)),
             pushed = held_by(bare_scene(many, {"constant_acceleration.radial=1e-9"}));
  MESSAGE("bytes at a kick: " << bare.at_kick << ", with a force " << pushed.at_kick);
  CHECK(pushed.at_kick - bare.at_kick == doctest::Approx(sizeof(Vec3)).epsilon(tolerance / sizeof(Vec3)));
  CHECK(pushed.all == doctest::Approx(pushed.at_kick).epsilon(tolerance / pushed.at_kick));
  CHECK(pushed.split.forces.size() == 1);
  CHECK(pushed.split.kick > 0.0);
  CHECK(pushed.split.force("gravity") == 0.0);
}

TEST_CASE("records of contacts are held for whom asks, and for nobody else") {
  set_threads(1);
  TakesRecords observer;
  const Held recorded = held_by(bare_scene(many), &observer);
  CHECK(observer.count > many / 4);
  CHECK(recorded.all - recorded.drift > 2.0 * tolerance);
  struct Idle final : collision::DriftObserver {
    bool wants_events() const override { return false; }
    void recorded(std::span<const collision::CollisionRecord>) override { FAIL("nobody asked"); }
  } idle;
  const Held unrecorded = held_by(bare_scene(many), &idle);
  CHECK(std::fabs(unrecorded.all - unrecorded.drift) < tolerance);
}

namespace {

// Returns the bytes that are freed when a recorder is destroyed after some steps of a run.
double held_by_recorder(const std::filesystem::path& folder, const Scene& scene) {
  RunFolder run(folder);
  run.make();
  Simulation simulation(scene, initial_patch(scene));
  const FolderLock lock(run.path());
  std::optional<Recorder> recorder(std::in_place, run, &lock, scene, std::vector<std::string>{}, OutputCounters{},
                                   std::nullopt, Recorder::Notice{}, Communicator());
  recorder->sample(simulation);
  recorder->watch(simulation);
  for (int k = 0; k < 3; ++k) {
    simulation.advance();
    recorder->contacts(simulation);
  }
  CHECK((recorder->costs().stresses > 0.0) == measures_gravity(scene));
  CHECK((recorder->costs().contacts > 0.0) == scene.output.collisions.has_value());
  const std::int64_t with = bytes_held;
  recorder.reset();
  return static_cast<double>(with - bytes_held);
}

} // namespace

TEST_CASE("what a recorder holds grows with the particles where it logs contacts, and only there") {
  const TemporaryFolder work;
  const auto growth = [&](const std::vector<std::string>& more) {
    const double few = held_by_recorder(work / "few", bare_scene(many / 10, more));
    return held_by_recorder(work / "all", bare_scene(many, more)) - few;
  };
  CHECK(growth({}) < 1000.0);
  for (const char* const gravity : {"gravity.solver=fft", "gravity.solver=tree"}) {
    CHECK(growth({gravity, "output.stress_every=0"}) < 1000.0);
    CHECK(growth({gravity, "output.stress_every=0.1"}) < 1000.0);
    CHECK(growth({gravity, "output.stress_every=0.1", "output.series_every=0.01"}) < 1000.0);
  }
  CHECK(growth({"output.collisions.fraction=1"}) > many);
}

TEST_CASE("a run of a scene that asks for nothing more spends no time on it and writes no file for it") {
  const TemporaryFolder work;
  const std::filesystem::path folder = work / "run";
  RunRequests requests;
  RunOptions options;
  options.folder = folder;
  start_run(bare_scene(500), options, requests);
  const nlohmann::json summary = nlohmann::json::parse(files::read_text(folder / "summary.json"));
  for (const char* const part : {"gravity_s", "stresses_s", "contacts_s", "force_checks_s"}) {
    CAPTURE(part);
    CHECK(summary["split"][part] == 0.0);
  }
  CHECK(summary["force_error"].is_null());
  CHECK(summary["energy_j"]["kick_work_of"].empty());
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"checkpoint_000000.h5", "log.jsonl", "scene.toml", "series.csv",
                                          "snap_000000.hdf", "snap_000001.hdf", "summary.json"});
}

} // namespace required_test
