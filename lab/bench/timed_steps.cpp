#include <keeler/bench/timed_steps.hpp>

#include <keeler/bench/yardsticks.hpp>
#include <keeler/collision/costs.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/statistics/median.hpp>

#include <algorithm>

namespace keeler::bench {
namespace {

constexpr int untimed_steps = 10;
// Per repeat:
constexpr double min_steps = 20.0;                               // more than two pruning intervals of the drift
constexpr double lifetime_steps = 64.0, lifetime_orbits = 0.159; // upper limits of the lifetime of neighbour lists
constexpr double enough_passes = 4e6;                            // particles × steps for a precise time,
constexpr double max_passes = 6.4e7;                             // and the largest number for a lifetime

// All clocks of a run at one moment, s.
struct Clocks {
  double whole = bench_seconds(), wall = wall_seconds();
  double drift, advance, gravity, kick;
  double build, reject, solve, events;

  explicit Clocks(Simulation& simulation) {
    const simulation::TimeSplit& split = simulation.time_split();
    const collision::DriftCosts costs = simulation.drift().costs();
    drift = split.drift - split.advance;
    advance = split.advance;
    gravity = -split.kick;
    for (const auto& [name, seconds] : split.forces)
      gravity += seconds;
    kick = split.kick;
    build = costs.build, reject = costs.reject, solve = costs.solve, events = costs.events;
  }
};

using Clock = double Clocks::*;

struct Lap {
  Clocks before, after;

  double seconds(Clock clock) const { return after.*clock - before.*clock; }
};

Lap run(Simulation& simulation, int steps) {
  const Clocks before(simulation);
  for (int k = 0; k < steps; ++k)
    simulation.advance();
  return {before, Clocks(simulation)};
}

// Speedups of each lap by several threads or ranks.
struct Gains {
  std::vector<double> step, drift, events, gravity, pair;

  void compare_threads(Simulation& simulation, const Lap& several, double pair_ns, int steps) {
    const int count = threads();
    set_threads(1);
    compare(run(simulation, steps), several);
    pair.push_back(pair_yardstick(wall_seconds) / pair_ns);
    set_threads(count);
  }

  // Runs `alone` on rank 0 while the other ranks wait.
  void compare_ranks(const Communicator& ranks, Simulation* alone, const Lap& distributed, int steps) {
    assert((alone != nullptr) == ranks.is_root());
    ranks.on_root([&] { compare(run(*alone, steps), distributed); });
    pair.push_back(1.0);
  }

  void compare(const Lap& one, const Lap& several) {
    const auto gain = [&](Clock clock) {
      return several.seconds(clock) > 0.0 ? one.seconds(clock) / several.seconds(clock) : 1.0;
    };
    step.push_back(gain(&Clocks::wall));
    drift.push_back(gain(&Clocks::drift));
    events.push_back(gain(&Clocks::events));
    gravity.push_back(gain(&Clocks::gravity));
  }

  Speedups medians() const {
    return {statistics::median(step), statistics::median(drift), statistics::median(events),
            statistics::median(gravity), statistics::median(pair)};
  }
};

void take_times(const std::vector<Lap>& laps, TimedSteps& timed) {
  const auto ns = [&](Clock clock) {
    std::vector<double> seconds;
    for (const Lap& lap : laps)
      seconds.push_back(lap.seconds(clock));
    return 1e9 * statistics::median(seconds) / (static_cast<double>(timed.count) * timed.steps);
  };
  timed.ns_per_particle_step = ns(timed.ranks > 1 ? &Clocks::wall : &Clocks::whole);
  timed.split = {ns(&Clocks::drift), ns(&Clocks::advance), ns(&Clocks::gravity), ns(&Clocks::kick)};
  timed.drift_split = {ns(&Clocks::build), ns(&Clocks::reject), ns(&Clocks::solve), ns(&Clocks::events)};
}

// All counts of a run at one moment.
struct Counts {
  CollisionTally tally;
  collision::DriftCosts costs;

  explicit Counts(Simulation& simulation) : tally(simulation.state().collisions), costs(simulation.drift().costs()) {}
};

// Replaces the counts that refer to the particles of one rank by their sums over the ranks.
void add_over_ranks(const Communicator& ranks, TimedSteps& timed) {
  for (std::uint64_t* const count : {&timed.recontacts, &timed.lists_made, &timed.lists_rebuilt, &timed.deferred,
                                     &timed.in_sequence, &timed.rolled_back, &timed.pairs_tested, &timed.survivors})
    *count = ranks.sum(*count);
}

// Returns the communication since `before`, as means over the ranks.
ExchangeSplit exchange_since(const comm::ExchangeCosts& before, const Communicator& ranks, double steps,
                             std::size_t count) {
  const comm::ExchangeCosts after = comm::exchange_costs(); // read before the sums below add to them
  const double each_step = 1.0 / (steps * static_cast<double>(ranks.size()));
  const auto total = [&](std::uint64_t number) { return static_cast<double>(ranks.sum(number)) * each_step; };
  const std::uint64_t messages = after.messages - before.messages, bytes = after.bytes - before.bytes;
  const std::uint64_t common = after.collectives - before.collectives;
  const auto ns = static_cast<std::uint64_t>(1e9 * (after.seconds - before.seconds));
  return {total(ns) / static_cast<double>(count), total(messages), total(bytes), total(common)};
}

void operator+=(ExchangeSplit& sum, const ExchangeSplit& more) {
  sum.ns += more.ns;
  sum.messages += more.messages;
  sum.bytes += more.bytes;
  sum.common += more.common;
}

void add_counts(const Counts& before, const Counts& after, TimedSteps& timed) {
  timed.collisions += after.tally.fast - before.tally.fast;
  timed.contacts += after.tally.fast + after.tally.slow - before.tally.fast - before.tally.slow;
  timed.recontacts += after.costs.recontacts - before.costs.recontacts;
  timed.lists_made += after.costs.lists_made - before.costs.lists_made;
  timed.lists_rebuilt += after.costs.lists_rebuilt - before.costs.lists_rebuilt;
  timed.deferred += after.costs.deferred - before.costs.deferred;
  timed.in_sequence += after.costs.in_sequence - before.costs.in_sequence;
  timed.rolled_back += after.costs.rolled_back - before.costs.rolled_back;
  timed.pairs_tested += after.costs.pairs_tested - before.costs.pairs_tested;
  timed.survivors += after.costs.survivors - before.costs.survivors;
  timed.repeated_steps += after.costs.repeated_steps - before.costs.repeated_steps;
  timed.widest_list = after.costs.widest_list;
  timed.bytes_per_particle = after.costs.bytes_per_particle;
}

} // namespace

double steps_worth_timing(std::size_t count, double step, double limit) {
  assert(step > 0.0);
  const double particles = static_cast<double>(std::max<std::size_t>(1, count));
  const double lower = std::max(min_steps, std::min({lifetime_steps, lifetime_orbits / step, max_passes / particles}));
  return std::clamp(enough_passes / particles, lower, std::max(lower, limit));
}

TimedSteps time_steps(Simulation& simulation, int steps, int repeats, int kick_every, PhaseProgress& progress,
                      Simulation* alone) {
  assert(repeats > 0 && kick_every > 0 && steps > 0 && steps % kick_every == 0);
  const Communicator& ranks = simulation.ranks();
  TimedSteps timed;
  timed.count = simulation.count();
  timed.ranks = ranks.size();
  timed.steps = steps;
  timed.repeats = repeats;
  progress.begin("timing", repeats);
  const int untimed = (untimed_steps + kick_every - 1) / kick_every * kick_every;
  run(simulation, untimed);
  if (alone)
    run(*alone, untimed);
  MemoryYardstick memory(simulation.state().particles.size());
  std::vector<double> line, pair;
  std::vector<Lap> laps;
  Gains gains;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    line.push_back(memory.measure());
    pair.push_back(pair_yardstick());
    const Counts before(simulation);
    ranks.any(false); // barrier: all ranks begin together
    const comm::ExchangeCosts exchanged = comm::exchange_costs();
    laps.push_back(run(simulation, steps));
    timed.exchange += exchange_since(exchanged, ranks, steps * repeats, timed.count);
    add_counts(before, Counts(simulation), timed);
    if (ranks.distributed())
      gains.compare_ranks(ranks, alone, laps.back(), steps);
    else if (threads() > 1)
      gains.compare_threads(simulation, laps.back(), pair.back(), steps);
    progress.add(1.0);
  }
  take_times(laps, timed);
  add_over_ranks(ranks, timed);
  timed.yardsticks = {statistics::median(line), statistics::median(pair)};
  if (ranks.is_root() && (ranks.distributed() || threads() > 1))
    timed.speedup = gains.medians();
  return timed;
}

} // namespace keeler::bench
