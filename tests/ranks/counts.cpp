// counts SCENE STEPS [KEY=VALUE ...]: makes steps of a scene on all ranks and prints what a rank holds and sends: the
// mean over the ranks, and the largest. All numbers are counts, so they are right on a machine with fewer processors
// than ranks.
#include <keeler/collision/costs.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/core/error.hpp>
#include <keeler/decomposition/blocks.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numeric>
#include <string>
#include <vector>

using namespace keeler;

namespace {

class Table {
public:
  explicit Table(const Communicator& ranks) : ranks_(ranks) {}

  void add(const char* name, double here) const {
    double sum = 0.0;
    for (const auto& of_rank : ranks_.exchange(std::vector(ranks_.size(), std::vector{here})))
      sum += of_rank.front();
    const double largest = ranks_.max(here);
    if (ranks_.is_root())
      fmt::print("{:<40} {:>14.2f} {:>14.2f}\n", name, sum / static_cast<double>(ranks_.size()), largest);
  }

private:
  const Communicator& ranks_;
};

void count(const Communicator& ranks, int argc, char** argv) {
  if (argc < 3)
    throw UsageError("counts SCENE STEPS [KEY=VALUE ...]");
  const Scene scene = load_scene(argv[1], std::vector<std::string>(argv + 3, argv + argc));
  const int steps = std::max(1, std::atoi(argv[2]));
  Simulation simulation(scene, initial_patch(scene, {}, ranks), ranks);
  if (!simulation.blocks())
    throw UsageError("start several ranks");
  simulation.advance(); // the first layer has no counted work
  const decomposition::Blocks& blocks = *simulation.blocks();
  const comm::ExchangeCosts before = comm::exchange_costs();
  const collision::DriftCosts costs = simulation.drift().costs();
  const collision::CollisionTally contacts_before = simulation.state().collisions;
  const std::uint64_t rebuilds = blocks.rebuilds(), migrants = blocks.migrants();
  double own = 0.0, ghosts = 0.0, near = 0.0, partners = 0.0;
  for (int step = 0; step < steps; ++step) {
    simulation.advance();
    const decomposition::GhostLayer& layer = blocks.ghosts();
    own += static_cast<double>(layer.own);
    ghosts += static_cast<double>(layer.ghosts());
    near += static_cast<double>(std::count(layer.near.begin(), layer.near.end(), 1));
    partners += static_cast<double>(layer.partners.size());
  }
  const comm::ExchangeCosts after = comm::exchange_costs();
  const auto each = [&](auto number) { return static_cast<double>(number) / steps; };
  const collision::CollisionTally& tally = simulation.state().collisions;
  if (ranks.is_root())
    fmt::print("{} ranks in {} strips, {} particles, {} steps, {} contacts\n{:<40} {:>14} {:>14}\n", ranks.size(),
               blocks.grid().strips(), simulation.count(), steps,
               tally.fast + tally.slow - contacts_before.fast - contacts_before.slow, "per rank", "mean", "largest");
  const Table table(ranks);
  table.add("own particles", each(own));
  table.add("ghosts", each(ghosts));
  table.add("near ghosts", each(near));
  table.add("partners", each(partners));
  table.add("margin, m", blocks.ghosts().margin);
  table.add("bytes sent per step", each(after.bytes - before.bytes));
  table.add("messages sent per step", each(after.messages - before.messages));
  table.add("collective calls per step", each(after.collectives - before.collectives));
  const collision::DriftCosts costs_after = simulation.drift().costs();
  table.add("pairs of lines tested per step", each(costs_after.pairs_tested - costs.pairs_tested));
  table.add("repeated steps", static_cast<double>(costs_after.repeated_steps - costs.repeated_steps));
  const auto& hits = blocks.ghosts().contacts;
  table.add("contacts of own particles, last layer", static_cast<double>(std::accumulate(hits.begin(), hits.end(), 0)));
  table.add("rebuilt layers", static_cast<double>(blocks.rebuilds() - rebuilds));
  table.add("particles sent to new owners per step", each(blocks.migrants() - migrants));
}

} // namespace

int main(int argc, char** argv) {
  try {
    count(Communicator::launched(), argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "counts: {}\n", error.what());
    comm::fail_ranks(ExitCode::usage);
    return 2;
  }
  comm::finish_ranks();
}
