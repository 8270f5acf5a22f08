// No rank of a run has all particles: its largest message and its memory are a fraction of the whole.
#include "launched.hpp"

#include "unit/files/disk.hpp"

#include <keeler/core/memory.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

using namespace keeler;
using keeler_test::launched;

namespace {

constexpr std::size_t count = 600000;
constexpr double piece = 16.0 * (1 << 20); // bytes
// bytes per own particle; bodies and ids of all ranks would add 288, and freed blocks that stay in the heap 200 on one
constexpr double max_memory = 560.0;

Scene many_particles() {
  return parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [6000, 600]
[particles]
count = 600000
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 2e-3
end = 4e-3
[output]
checkpoint_every = 2e-3
)",
                     "test scene", {});
}

} // namespace

TEST_CASE("a run and its snapshots, checkpoints, hash and resumption keep particles where they are") {
  const Communicator& ranks = launched();
  std::unique_ptr<test::TemporaryFolder> folder;
  if (ranks.is_root())
    folder = std::make_unique<test::TemporaryFolder>();
  std::string path = folder ? *folder / "run" : "";
  ranks.broadcast(path);

  const double before = peak_memory();
  runs::RunOptions options;
  options.folder = path;
  options.ranks = ranks;
  runs::RunRequests requests;
  const runs::RunResult run = start_run(many_particles(), options, requests);
  options.until_orbits = 8e-3;
  const runs::RunResult resumed = resume_run(options, requests);
  CHECK(run.finished);
  CHECK(resumed.step == 4);

  const double own = static_cast<double>(count) / static_cast<double>(ranks.size());
  CHECK(static_cast<double>(comm::exchange_costs().max_bytes) < 1.05 * piece);
  const double memory = (peak_memory() - before) / own;
  MESSAGE("rank " << ranks.rank() << ": " << 1e-6 * static_cast<double>(comm::exchange_costs().max_bytes)
                  << " MB at once, " << memory << " bytes of memory per own particle");
  CHECK(memory < max_memory + (ranks.is_root() ? 2.0 * piece / own : 0.0)); // the root writes the pieces
  // gathering the bodies alone exceeds a piece: the counter shows it
  const std::vector<std::byte> bodies(64 * static_cast<std::size_t>(own));
  ranks.gather(bodies);
  CHECK((!ranks.is_root() || static_cast<double>(comm::exchange_costs().max_bytes) > 2.0 * piece));
}
