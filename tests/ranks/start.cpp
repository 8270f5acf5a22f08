// Starts that ranks read or get in parts, against one process: equal bits and errors.
#include "launched.hpp"

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

using namespace keeler;
using keeler_test::launched;

namespace {

Scene a_scene(const std::vector<std::string>& overrides = {}) {
  return parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [80, 50]
[particles]
count = 600
density = 600.0
sizes = { law = "power", exponent = 3.0, min = 0.4, max = 1.6 }
[time]
step = 2e-3
end = 0.1
)",
                     "test scene", overrides);
}

// A snapshot that the root has written.
class SharedSnapshot {
public:
  explicit SharedSnapshot(const Patch& patch) {
    if (launched().is_root())
      folder_ = std::make_unique<test::TemporaryFolder>();
    path_ = folder_ ? (*folder_ / "start.hdf").string() : "";
    launched().broadcast(path_);
    launched().on_root([&] { io::write_snapshot(path_, patch, {a_scene().resolved, {}}); });
  }
  ~SharedSnapshot() { launched().any(false); } // removes the folder after all ranks arrived
  SharedSnapshot(const SharedSnapshot&) = delete;
  SharedSnapshot& operator=(const SharedSnapshot&) = delete;

  const std::string& path() const { return path_; }
  void drop_seal() const {
    launched().on_root([&] { std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 64); });
  }

private:
  std::unique_ptr<test::TemporaryFolder> folder_;
  std::string path_;
};

// Returns the particles whose id modulo the number of ranks is this rank.
Patch part_of(Patch patch) {
  const auto keep = [&](auto& rows) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (patch.ids[k] % launched().size() == launched().rank())
        rows[kept++] = rows[k];
    rows.resize(kept);
  };
  keep(patch.positions), keep(patch.velocities), keep(patch.radii), keep(patch.masses), keep(patch.spins);
  keep(patch.ids); // last: all others depend on the ids
  return patch;
}

template<class Row> std::vector<Row> of_all(const std::vector<Row>& rows) {
  return launched().gather(rows);
}

template<class Row> bool same_bytes(const std::vector<Row>& a, const std::vector<Row>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(static_cast<const void*>(a.data()), b.data(), a.size() * sizeof(Row)) == 0);
}

// Returns the text of the error that `work` throws.
template<class Work> std::string words_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string hash_after(Simulation& simulation, const Scene& its, int steps) {
  for (int k = 0; k < steps; ++k)
    simulation.advance();
  return runs::state_hash(simulation.state(), its, simulation.ranks());
}

} // namespace

TEST_CASE("work that one rank interrupts is interrupted on all, which may go on") {
  for (std::size_t rank = 0; rank < launched().size(); ++rank) {
    const auto interrupt = [&] {
      if (launched().rank() == rank)
        throw Interrupted();
    };
    CHECK_THROWS_AS(launched().together(interrupt), Interrupted);
    const auto interrupt_or_fail = [&] {
      if (launched().rank() == rank)
        throw InvariantError("a fault");
      throw Interrupted();
    };
    CHECK_THROWS_WITH_AS(launched().together(interrupt_or_fail), "a fault", Error);
    CHECK(launched().max(static_cast<double>(launched().rank())) == static_cast<double>(launched().size() - 1));
  }
}

TEST_CASE("a snapshot is read in consecutive parts, and without a seal by the root") {
  for (const bool rough : {false, true}) {
    const Patch patch = initial_patch(rough ? a_scene({"collisions.friction.tangential_restitution=0.5"}) : a_scene());
    const SharedSnapshot file(patch);
    const Patch whole = io::read_snapshot(file.path()).patch;
    for (const bool sealed : {true, false}) {
      if (!sealed)
        file.drop_seal();
      const Patch part = io::read_snapshot(file.path(), launched()).patch;
      CHECK((!sealed || part.size() <= whole.size() / launched().size() + 1));
      CHECK((sealed || part.size() == (launched().is_root() ? whole.size() : 0)));
      const auto positions = of_all(part.positions), velocities = of_all(part.velocities), spins = of_all(part.spins);
      const auto radii = of_all(part.radii), masses = of_all(part.masses);
      const auto ids = of_all(part.ids);
      if (!launched().is_root())
        continue;
      CHECK(same_bytes(positions, whole.positions));
      CHECK(same_bytes(velocities, whole.velocities));
      CHECK(same_bytes(spins, whole.spins));
      CHECK(same_bytes(radii, whole.radii));
      CHECK(same_bytes(masses, whole.masses));
      CHECK(ids == whole.ids);
    }
  }
}

TEST_CASE("ids that do not increase from one part to the next are an error on all ranks") {
  Patch patch = initial_patch(a_scene());
  const std::size_t border = patch.size() / launched().size();
  patch.ids[border] = patch.ids[border - 1];
  const SharedSnapshot file(patch);
  CHECK(words_of([&] { io::read_snapshot(file.path(), launched()); }).find("ParticleIDs do not increase") !=
        std::string::npos);
}

TEST_CASE("a run from a snapshot has the bits of one process, for any distribution of the particles read") {
  const SharedSnapshot file(initial_patch(a_scene()));
  for (const char* keep : {"1.0", "0.6"})
    for (const bool rough : {false, true}) {
      std::vector<std::string> overrides{std::string("start.keep_fraction=") + keep};
      if (rough)
        overrides.emplace_back("collisions.friction.tangential_restitution=0.5");
      std::string text = "[planet]\npreset = \"saturn-a-ring\"\n[start]\nfrom = \"" + file.path() +
                         "\"\n[time]\nstep = 2e-3\nend = 0.1\n";
      const Scene from = parse_scene(text, "test scene", overrides);
      Simulation alone(from, initial_patch(from)), distributed(from, initial_patch(from, {}, launched()), launched()),
          odd(from, part_of(initial_patch(from)), launched());
      const std::string expected = hash_after(alone, from, 20);
      CHECK(hash_after(distributed, from, 20) == expected);
      CHECK(hash_after(odd, from, 20) == expected);
      CHECK(distributed.state().energy.epicyclic == alone.state().energy.epicyclic);
      CHECK(distributed.state().energy.spin == alone.state().energy.spin);
      CHECK(initial_conditions::scale_of(initial_patch(from, {}, launched()), launched()).particle_count ==
            alone.count());
    }
}

TEST_CASE("particles of two ranks that overlap are named as one process names them") {
  Patch patch = initial_patch(a_scene());
  patch.positions[7] = patch.positions[320]; // of two parts, whatever the number of ranks
  patch.positions[401] = patch.positions[122] + Vec3(0.3, 0.0, 0.0);
  const std::string expected = words_of([&] { Simulation(a_scene(), patch); });
  CHECK(expected.find("overlap by") != std::string::npos);
  CHECK(words_of([&] { Simulation(a_scene(), part_of(patch), launched()); }) == expected);
}

TEST_CASE("an impossible state is an error on all ranks, in the words of one process") {
  const Patch patch = initial_patch(a_scene());
  const auto words = [](const Patch& start) {
    const SharedSnapshot file(start);
    const Scene from = parse_scene("[planet]\npreset = \"saturn-a-ring\"\n[start]\nfrom = \"" + file.path() +
                                       "\"\n[time]\nstep = 2e-3\nend = 0.1\n",
                                   "test scene", {});
    const std::string expected = words_of([&] { initial_patch(from); });
    CHECK(words_of([&] { initial_patch(from, {}, launched()); }) == expected);
    return expected;
  };
  Patch negative = patch, elsewhere = patch, none = patch;
  negative.radii[patch.size() - 1] = -1.0;
  CHECK(words(negative).find("a radius that is not positive") != std::string::npos);
  elsewhere.orbital_frequency *= 2.0;
  CHECK(words(elsewhere).find("was made for another orbit") != std::string::npos);
  none.positions.clear(), none.velocities.clear(), none.radii.clear(), none.masses.clear(), none.ids.clear();
  CHECK(words(none).find("holds no particles") != std::string::npos);
}

TEST_CASE("a stop requested on one rank during a start ends all ranks with one message") {
  const test::TemporaryFolder own;
  std::string folder = (own / "run").string();
  launched().broadcast(folder); // all ranks get one request
  runs::RunOptions options;
  options.folder = folder;
  options.ranks = launched();
  runs::RunRequests requests;
  int calls = 0;
  options.start_progress = [&](const initial_conditions::StartProgress&) {
    requests.stop = ++calls == 3 && launched().is_root();
  };
  const std::string words = words_of([&] { start_run(a_scene(), options, requests); });
  CHECK(words.find("stopped before the first step (on request)") == 0);
  CHECK(calls == 3);
  CHECK_FALSE(std::filesystem::exists(options.folder));
  launched().any(false); // removes the folder after all ranks arrived
}
