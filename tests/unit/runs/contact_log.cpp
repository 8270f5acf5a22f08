#include "contact_log.hpp"

#include "scenes.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/runs/run.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace contact_log_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

/// Records all contacts, one call per contact.
struct Onlooker final : collision::DriftObserver {
  std::vector<collision::CollisionRecord> records;
  void collided(const collision::CollisionRecord& record) override { records.push_back(record); }
};

const std::vector<std::string> logged = {"time.end=0.4", "output.collisions.fraction=1.0", "output.snapshot_every=0.1",
                                         "output.checkpoint_every=0.04"};

std::vector<std::string> logged_with(const std::vector<std::string>& more) {
  std::vector<std::string> all = logged;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

RunOptions in(const std::filesystem::path& folder) {
  RunOptions options;
  options.folder = folder;
  return options;
}

void run(const std::filesystem::path& folder, const std::vector<std::string>& overrides) {
  RunRequests requests;
  start_run(small_scene(overrides), in(folder), requests);
}

std::vector<io::ContactRow> rows_in(const std::filesystem::path& folder) {
  return io::read_contacts(RunFolder(folder).contacts(0)).rows;
}

ContactLog new_log(const RunFolder& folder, const Scene& scene, std::int64_t file_rows = 10,
                   const std::optional<LogResume>& resume = {}) {
  return {folder, scene, {}, resume, file_rows};
}

// Returns all rows of a log of small files.
std::vector<io::ContactRow> table_in(const RunFolder& folder, std::int64_t file_rows) {
  std::vector<io::ContactRow> all;
  for (std::int64_t number = 0; std::filesystem::exists(folder.contacts(number)); ++number) {
    const io::ContactFile file = io::read_contacts(folder.contacts(number));
    CHECK(file.meta.first_row == number * file_rows);
    CHECK(static_cast<std::int64_t>(file.rows.size()) <= file_rows);
    all.insert(all.end(), file.rows.begin(), file.rows.end());
  }
  return all;
}

} // namespace

TEST_CASE("the log holds what an observer sees, in SI") {
  const TemporaryFolder work;
  const Scene scene = small_scene({"output.collisions.fraction=1.0"});
  const double omega = scene.planet.orbital_frequency, h = scene.time.step;
  const RunFolder folder(work.path());
  Simulation one(scene, initial_patch(scene)), other(scene, initial_patch(scene));
  ContactLog log = new_log(folder, scene);
  log.watch(one);
  Onlooker onlooker;
  other.drift().observe(&onlooker);
  std::vector<std::int64_t> steps;
  for (int k = 0; k < 60; ++k) {
    one.advance();
    log.write_full_files();
    other.advance();
    steps.resize(onlooker.records.size(), k);
  }
  log.write_all();
  const std::vector<io::ContactRow> rows = table_in(folder, 10);
  REQUIRE(rows.size() == onlooker.records.size());
  REQUIRE(rows.size() > 30);
  CHECK(log.counters().rows == static_cast<std::int64_t>(rows.size()));
  const Patch patch = one.patch();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const collision::CollisionRecord& r = onlooker.records[k];
    const io::ContactRow& row = rows[k];
    CHECK(row.step == steps[k]);
    CHECK(row.time_orbits >= static_cast<double>(row.step) * h * (1 - 1e-12));
    CHECK(row.time_orbits <= static_cast<double>(row.step + 1) * h * (1 + 1e-12));
    CHECK(row.low_id == r.low_id);
    CHECK(row.high_id == r.high_id);
    CHECK(row.image == r.image);
    CHECK(row.position == r.contact_point);
    CHECK(row.normal_speed == r.normal_speed * omega);
    CHECK(row.tangential_speed == r.tangential_speed * omega);
    CHECK(row.fast == r.fast);
    CHECK(row.normal == r.normal);
    CHECK(row.impulse == r.impulse * omega);
    CHECK(row.normal.norm() == doctest::Approx(1.0));
    CHECK(r.radius_sum == doctest::Approx(patch.radii[r.low_id] + patch.radii[r.high_id]));
    CHECK(std::fabs(row.position.x()) < scene.size_x);
    CHECK((k == 0 || rows[k - 1].time_orbits <= row.time_orbits));
  }
  // smooth spheres: the impulse is along the line of centres and turns the approach into the rebound
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const io::ContactRow& row = rows[k];
    const double low = patch.masses[row.low_id], high = patch.masses[row.high_id], reduced = low * high / (low + high);
    const double push = row.impulse.dot(row.normal), rebound = push / reduced - row.normal_speed;
    CHECK((row.impulse - push * row.normal).norm() < 1e-12 * push);
    const double energy = 0.5 * reduced * (row.normal_speed * row.normal_speed - rebound * rebound);
    CHECK(onlooker.records[k].energy_lost * omega * omega ==
          doctest::Approx(energy).epsilon(1e-9).scale(reduced * row.normal_speed * row.normal_speed));
    const Vec3 centre = row.position - patch.radii[row.low_id] * row.normal; // of the particle with the lower id
    CHECK(std::fabs(centre.z()) < scene.size_x);
  }
  double lost = 0.0;
  std::uint64_t count = 0;
  const ImpactSpeeds& speeds = log.counters().speeds;
  for (std::size_t bin = 0; bin < speeds.bins(); ++bin)
    lost += speeds.energy_lost(bin), count += speeds.count(bin);
  CHECK(count == rows.size());
  CHECK(lost == doctest::Approx(one.state().collisions.energy_lost * omega * omega).epsilon(1e-12));
}

TEST_CASE("a bin holds the speeds from its lower edge to below its upper one") {
  ImpactSpeeds speeds;
  for (const double speed : {0.0, 1e-7, 9.99e-4, 1e-3, 10.0, 1e9})
    speeds.add(speed, 2.0);
  std::uint64_t count = 0;
  for (std::size_t bin = 0; bin < speeds.bins(); ++bin) {
    count += speeds.count(bin);
    CHECK(speeds.energy_lost(bin) == 2.0 * static_cast<double>(speeds.count(bin)));
    CHECK((bin == 0 || speeds.lower_edge(bin) == speeds.upper_edge(bin - 1)));
  }
  CHECK(count == 6);
  CHECK(speeds.count(0) == 1);
  CHECK(speeds.count(1) == 1);
  CHECK(speeds.count(speeds.bins() - 1) == 2);
  speeds.clear();
  CHECK(speeds.count(0) == 0);
}

TEST_CASE("filters keep the contacts that they name, and a share is a share") {
  collision::CollisionRecord record{};
  record.normal_speed = 10.0;
  record.radius_sum = 2.0;
  CHECK(is_logged({.min_speed = 1e-3}, record, 0.1, 1e-4));
  CHECK_FALSE(is_logged({.min_speed = 1.1e-3}, record, 0.1, 1e-4));
  CHECK(is_logged({.min_radius_sum = 2.0}, record, 0.1, 1e-4));
  CHECK_FALSE(is_logged({.min_radius_sum = 2.1}, record, 0.1, 1e-4));
  int kept = 0;
  for (int k = 0; k < 10000; ++k) {
    record.low_id = static_cast<std::uint64_t>(k % 100), record.high_id = static_cast<std::uint64_t>(100 + k / 100);
    const double time = 0.001 * (k % 7);
    kept += is_logged({.fraction = 0.3}, record, time, 1e-4);
    CHECK(is_logged({.fraction = 0.3}, record, time, 1e-4) <= is_logged({.fraction = 0.6}, record, time, 1e-4));
  }
  CHECK(std::abs(kept - 3000) < 5 * 46); // five standard deviations
}

TEST_CASE("the log of a run does not depend on threads, and the run not on the log") {
  const TemporaryFolder work;
  const int before = threads();
  RunRequests requests;
  const std::string hash = start_run(small_scene({"time.end=0.4"}), in(work / "off"), requests).state_hash;
  CHECK_FALSE(std::filesystem::exists(work / "off" / "collisions_000000.h5"));
  CHECK_FALSE(std::filesystem::exists(work / "off" / "impact_speeds.csv"));
  for (const int count : {1, 2, 3}) {
    set_threads(count);
    const auto folder = work / std::to_string(count);
    CHECK(start_run(small_scene(logged), in(folder), requests).state_hash == hash);
    CHECK((rows_in(folder) == rows_in(work / "1")));
    CHECK(files::read_text(folder / "impact_speeds.csv") == files::read_text(work / "1" / "impact_speeds.csv"));
  }
  set_threads(before);
  CHECK(rows_in(work / "1").size() > 40);

  run(work / "share", logged_with({"output.collisions.fraction=0.5"}));
  run(work / "fast", logged_with({"output.collisions.min_speed=1e-4"}));
  std::size_t fast = 0;
  for (const io::ContactRow& row : rows_in(work / "1"))
    fast += row.normal_speed >= 1e-4;
  CHECK(rows_in(work / "fast").size() == fast);
  CHECK(rows_in(work / "share").size() < rows_in(work / "1").size());
  CHECK(files::read_text(work / "share" / "impact_speeds.csv") == files::read_text(work / "1" / "impact_speeds.csv"));
}

TEST_CASE("contacts at rest are logged at each kick, with the impulse that holds the pair apart") {
  const TemporaryFolder work;
  const std::vector<std::string> pile = {"particles.density=1500", "particles.sizes={law=\"equal\",radius=1.0}",
                                         "particles.aggregate=[{count=100,position=[0.0,0.0,0.0],filling_factor=0.45}]",
                                         "gravity={solver=\"direct\",kick_every=2,resting_contacts=\"carried\"}",
                                         "output.collisions={at_rest=\"logged\",min_radius_sum=1.0}"};
  const Scene scene = small_scene(pile);
  const RunFolder folder(work.path());
  Simulation simulation(scene, initial_patch(scene));
  ContactLog log = new_log(folder, scene, 1'000'000);
  log.watch(simulation);
  std::size_t expected = 0, kicks = 0;
  std::vector<contact_solver::RestingLoad> loads;
  Patch patch = simulation.patch();
  while (simulation.state().step < 40) {
    simulation.advance();
    log.add_contacts_at_rest(members_at_rest(scene, simulation));
    if (simulation.state().step % 2 != 0)
      continue;
    loads = simulation.state().resting.loads;
    expected += loads.size(), ++kicks;
    patch = simulation.patch();
  }
  log.write_all();
  std::vector<io::ContactRow> resting, last;
  for (const io::ContactRow& row : rows_in(work.path()))
    if (row.at_rest)
      resting.push_back(row);
  REQUIRE(resting.size() == expected);
  REQUIRE(loads.size() > 20);
  last.assign(resting.end() - static_cast<std::ptrdiff_t>(loads.size()), resting.end());
  const double omega = scene.planet.orbital_frequency;
  for (std::size_t k = 0; k < last.size(); ++k) {
    const io::ContactRow& row = last[k];
    CHECK(row.step == 40);
    CHECK(row.impulse.dot(row.normal) == doctest::Approx(loads[k].impulse * omega));
    CHECK(row.impulse.dot(row.normal) >= 0.0); // contacts push
    CHECK((row.position - patch.positions[row.low_id]).norm() == doctest::Approx(1.0));
    const Vec3 other = patch.positions[row.high_id] + patch.box.displacement(row.image, patch.offset);
    CHECK((other - patch.positions[row.low_id] - loads[k].separation).norm() < 1e-9);
    CHECK((row.position - other).norm() == doctest::Approx(1.0).epsilon(0.1)); // at contact, but for the scheme's gaps
    CHECK(row.normal_speed == 0.0);
    CHECK_FALSE(row.fast);
  }
  const Scene without = small_scene([&] {
    std::vector<std::string> keys = pile;
    keys.back() = "output.collisions={min_radius_sum=1.0}";
    return keys;
  }());
  const RunFolder other(work / "other");
  other.make();
  ContactLog silent = new_log(other, without);
  silent.watch(simulation);
  silent.add_contacts_at_rest(members_at_rest(without, simulation));
  CHECK(silent.counters().rows == 0);
}

TEST_CASE("a run that goes on from a checkpoint has the log of a run without a break") {
  const TemporaryFolder work;
  run(work / "whole", logged);
  run(work / "half", logged_with({"time.end=0.2"}));
  RunRequests requests;
  RunOptions options = in(work / "half");
  options.until_orbits = 0.4;
  // files that are newer than the checkpoint, as a kill leaves them
  std::filesystem::copy_file(work / "whole" / "collisions_000000.h5", work / "half" / "collisions_000000.h5",
                             std::filesystem::copy_options::overwrite_existing);
  std::filesystem::copy_file(work / "whole" / "impact_speeds.csv", work / "half" / "impact_speeds.csv",
                             std::filesystem::copy_options::overwrite_existing);
  resume_run(options, requests);
  CHECK((rows_in(work / "half") == rows_in(work / "whole")));
  CHECK(files::read_text(work / "half" / "impact_speeds.csv") ==
        files::read_text(work / "whole" / "impact_speeds.csv"));
}

TEST_CASE("files of a log are cut back to the rows of a checkpoint, wherever that falls") {
  const TemporaryFolder work;
  const Scene scene = small_scene({"output.collisions.fraction=1.0"});
  const auto evolve = [&](ContactLog& log, Simulation& simulation, int until) {
    log.watch(simulation);
    while (simulation.state().step < until) {
      simulation.advance();
      log.write_full_files();
    }
  };
  for (const std::int64_t file_rows : {1, 7, 50}) {
    const RunFolder whole(work / ("whole" + std::to_string(file_rows)));
    const RunFolder cut(work / ("cut" + std::to_string(file_rows)));
    whole.make(), cut.make();
    Simulation simulation(scene, initial_patch(scene));
    ContactLog log = new_log(whole, scene, file_rows);
    evolve(log, simulation, 30);
    log.write_all();

    Simulation first(scene, initial_patch(scene));
    ContactLog before = new_log(cut, scene, file_rows);
    evolve(before, first, 15);
    before.write_all();
    const LogResume checkpoint{before.counters(), -1};
    const simulation::SimulationState state = first.state();
    evolve(before, first, 25); // lost by a kill
    before.write_all();

    Simulation second(scene, state);
    ContactLog after = new_log(cut, scene, file_rows, checkpoint);
    CHECK(after.lost_rows() == 0);
    evolve(after, second, 30);
    after.write_all();
    const std::vector<io::ContactRow> rows = table_in(whole, file_rows);
    CHECK(rows.size() > 15);
    CHECK((table_in(cut, file_rows) == rows));
  }
}

TEST_CASE("a log whose last file is gone or damaged goes on with a gap, and says so") {
  const TemporaryFolder work;
  for (const bool gone : {true, false}) {
    const auto folder = work / (gone ? "gone" : "damaged");
    run(folder, logged_with({"time.end=0.2"}));
    const auto lost = static_cast<std::int64_t>(rows_in(folder).size());
    const auto file = folder / "collisions_000000.h5";
    const std::string content = files::read_text(file);
    std::filesystem::remove(file);
    if (!gone)
      files::write_text(file, content.substr(0, content.size() / 2));
    RunRequests requests;
    RunOptions options = in(folder);
    options.until_orbits = 0.4;
    std::string said;
    options.notice = [&](const std::string& line) { said += line; };
    resume_run(options, requests);
    CHECK(said.find("rows of the log of contacts are missing or damaged") != said.npos);
    CHECK(io::read_contacts(file).meta.first_row == lost);
    CHECK(!io::read_contacts(file).rows.empty());
  }
}

TEST_CASE("a log that cannot be written ends the run before its first step; with room it goes on where it was") {
  const TemporaryFolder work;
  run(work / "whole", logged);
  run(work / "run", logged_with({"time.end=0.2"}));
  RunRequests requests;
  RunOptions options = in(work / "run");
  options.until_orbits = 0.4;
  {
    const SmallDisk disk(9000); // the scene and the series fit
    CHECK_THROWS_AS(resume_run(options, requests), DiskFullError);
  }
  resume_run(options, requests);
  CHECK((rows_in(work / "run") == rows_in(work / "whole")));
}

} // namespace contact_log_test
