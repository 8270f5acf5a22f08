#include "settled.hpp"

#include "gravity_states.hpp"
#include "unit/files/disk.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/tiled.hpp>
#include <keeler/simulation/simulation.hpp>

#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace settled_test {

using namespace keeler;
using namespace keeler::bench;

namespace {

// The bench's physics in 2 × 2 λ_cr. Particles collide soon, since the start is thin.
Scene small_scene() {
  Scene scene = a_ring_scene(1, 1);
  scene.gravity->solver = GravitySettings::Solver::fft;
  scene.gravity->kick_every = 5;
  scene.particles.velocity_dispersion = 1.0;
  scene.time.end_step = 200;
  return scene;
}

BenchState state_of(const Scene& scene, std::size_t count, const test::TemporaryFolder& folder) {
  PhaseProgress silent({});
  return settled_state(scene, count, folder.path(), silent);
}

// Collects the contacts of a tiled patch by the two particles of the tile.
struct ContactTimes final : collision::DriftObserver {
  explicit ContactTimes(std::size_t tile_size) : tile(tile_size) {}
  bool wants_events() const override { return false; }
  bool wants_records() const override { return true; }
  void recorded(std::span<const collision::CollisionRecord> contacts) override {
    for (const collision::CollisionRecord& contact : contacts) {
      const std::uint64_t low = contact.low_id % tile, high = contact.high_id % tile;
      times[{step, std::min(low, high), std::max(low, high)}].push_back(contact.time);
    }
  }

  std::size_t tile;
  int step = 0;
  std::map<std::tuple<int, std::uint64_t, std::uint64_t>, std::vector<double>> times;
};

// Returns the fraction of contacts that a copy has at the same time, to 1e-6 of a step.
double simultaneous(const Scene& scene, const Patch& patch, std::size_t tile) {
  Simulation simulation(scene, patch);
  ContactTimes contacts(tile);
  simulation.drift().observe(&contacts);
  for (; contacts.step < 20; ++contacts.step)
    simulation.advance();
  const double same = 1e-6 * simulation.state().step_length;
  double all = 0.0, shared = 0.0;
  for (auto& [pair, times] : contacts.times) {
    std::sort(times.begin(), times.end());
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool before = k > 0 && times[k] - times[k - 1] < same;
      const bool after = k + 1 < times.size() && times[k + 1] - times[k] < same;
      shared += before || after ? 1.0 : 0.0;
      all += 1.0;
    }
  }
  MESSAGE("contacts: ", all, ", simultaneous: ", shared / all);
  REQUIRE(all > 100.0);
  return shared / all;
}

} // namespace

TEST_CASE("copies of a settled patch collide at times of their own") {
  const Scene scene = small_scene();
  const test::TemporaryFolder folder;
  const BenchState state = state_of(scene, 4 * scene.particles.count, folder);
  const std::size_t tile = scene.particles.count;
  REQUIRE(state.patch.size() == 4 * tile);
  CHECK(state.patch.box.size_x == doctest::Approx(2.0 * scene.size_x));
  CHECK(cells::largest_overlap(state.patch).depth < 1e-12);
  CHECK(simultaneous(scene, state.patch, tile) < 0.01);
  const Patch copies = initial_conditions::tiled_patch(initial_patch(scene), 2, 2);
  CHECK(simultaneous(scene, copies, tile) > 0.9); // what tiles do by themselves
}

TEST_CASE("tiles are about as many as asked, in as many rows as columns") {
  Scene scene = small_scene();
  scene.time.end_step = 5;
  const test::TemporaryFolder folder;
  const auto count = static_cast<double>(scene.particles.count);
  for (const auto& [asked, columns, rows] : {std::tuple{0.1, 1, 1}, {1.4, 1, 1}, {1.6, 2, 1}, {2.6, 1, 2}}) {
    const Patch patch = state_of(scene, static_cast<std::size_t>(asked * count), folder).patch;
    CHECK(patch.size() == static_cast<std::size_t>(columns * rows) * scene.particles.count);
    CHECK(patch.box.size_x == doctest::Approx(columns * scene.size_x));
    CHECK(patch.box.size_y == doctest::Approx(rows * scene.size_y));
  }
}

TEST_CASE("a settled state has the same bits on any number of threads, made or read") {
  Scene scene = small_scene();
  scene.time.end_step = 50;
  const test::TemporaryFolder one, two;
  const int before = threads();
  set_threads(1);
  const Patch made = state_of(scene, 1, one).patch, read = state_of(scene, 1, one).patch;
  CHECK(one.file_count() == 1);
  set_threads(2);
  const Patch on_two = state_of(scene, 1, two).patch;
  set_threads(before);
  for (const Patch* other : {&read, &on_two}) {
    CHECK(other->positions == made.positions);
    CHECK(other->velocities == made.velocities);
  }
}

} // namespace settled_test
