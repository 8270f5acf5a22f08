#include "bench_numbers.hpp"

#include <keeler/core/threads.hpp>

#include <cassert>

namespace keeler::cli {
namespace {

namespace unit = quantities::unit;
using quantities::Quantity, quantities::QuantityRow, quantities::Record, quantities::of_digits, quantities::word;
using Timed = const bench::TimedSteps&;
using TimedRows = std::vector<QuantityRow<bench::TimedSteps>>;

constexpr quantities::Unit ns = unit::unnamed("ns"), times = unit::unnamed("times");

Quantity three_digits(const std::string& name, const quantities::Unit& in, const std::string& label,
                      const char* meaning) {
  return of_digits(3, {name, in, label, meaning});
}

bool has_many_ranks(Timed t) {
  return t.ranks > 1;
}

bool has_speedup(Timed t) {
  return t.ranks > 1 || threads() > 1;
}

TimedRows phase_rows(const std::string& object, const std::string& before) {
  const auto phase = [&](const char* name, const char* label, const char* meaning) {
    return three_digits(object + "." + name, ns, before + label, meaning);
  };
  return {{phase("build", "build", "building neighbour lists"), [](Timed t) { return t.drift_split.build; }},
          {phase("reject", "reject", "rejecting pairs that cannot touch in the step"),
           [](Timed t) { return t.drift_split.reject; }},
          {phase("solve", "solve", "the finder on the remaining pairs, at the start of the step"),
           [](Timed t) { return t.drift_split.solve; }},
          {phase("events", "events", "resolving contacts, and the searches after them"),
           [](Timed t) { return t.drift_split.events; }}};
}

// Returns the rows of the counts and of the machine's speed.
TimedRows count_rows() {
  return {
      {three_digits("pairs_per_particle", unit::none, "pairs tested per particle",
                    "per step, to build neighbour lists"),
       [](Timed t) { return t.per_particle_step(t.pairs_tested); }},
      {three_digits("survivors_per_particle", unit::none, "pairs for the finder per particle",
                    "at the start of a step"),
       [](Timed t) { return t.per_particle_step(t.survivors); }},
      {{"contacts", unit::none, "", "fast and slow, in all repeats"}, [](Timed t) { return t.contacts; }},
      {{"recontacts", unit::none, "", "contacts of a pair that has touched before in the step"},
       [](Timed t) { return t.recontacts; }},
      {{"lists_made", unit::none, "", "number of times that all neighbour lists were built"},
       [](Timed t) { return t.lists_made; }},
      {{"listed_anew", unit::none, "", "particles with a list rebuilt within the lifetime of the lists"},
       [](Timed t) { return t.lists_rebuilt; }},
      {{"deferred", unit::none, "", "events that domains left to the second round"},
       [](Timed t) { return t.deferred; }},
      {{"in_sequence", unit::none, "", "events that were left to the last round, on one thread"},
       [](Timed t) { return t.in_sequence; }},
      {{"rolled_back", unit::none, "", "contacts undone, because of an earlier one of their particles"},
       [](Timed t) { return t.rolled_back; }},
      {{"widest_list", unit::none, "", "largest number of neighbours of a particle"},
       [](Timed t) { return t.widest_list; }},
      {{"bytes_per_particle", unit::none, "bytes per particle", "memory of the drift"},
       [](Timed t) { return std::uint64_t{t.bytes_per_particle}; }},
      {three_digits("yardsticks.line_ns", ns, "yardstick: a line of memory", "time to read and write a line of memory"),
       [](Timed t) { return t.yardsticks.line_ns; }},
      {three_digits("yardsticks.pair_ns", ns, "yardstick: a pair", "time for |d|² and d·v of a pair"),
       [](Timed t) { return t.yardsticks.pair_ns; }}};
}

TimedRows rank_rows() {
  return {
      {{"ranks", unit::none, "ranks", "number of ranks"},
       [](Timed t) { return std::uint64_t{t.ranks}; },
       has_many_ranks},
      {three_digits("exchange.ns", ns, "  exchange", "per particle and step, waiting included"),
       [](Timed t) { return t.exchange.ns; }, has_many_ranks},
      {three_digits("exchange.messages", unit::none, "  messages per step", "sent per rank and step"),
       [](Timed t) { return t.exchange.messages; }, has_many_ranks},
      {three_digits("exchange.bytes", unit::none, "  bytes per step", "sent per rank and step"),
       [](Timed t) { return t.exchange.bytes; }, has_many_ranks},
      {three_digits("exchange.common", unit::none, "  collective calls per step", "sums and other calls of all ranks"),
       [](Timed t) { return t.exchange.common; }, has_many_ranks},
      {{"shared_again", unit::none, "  repeated steps", "of the timed steps"},
       [](Timed t) { return t.repeated_steps; },
       has_many_ranks}};
}

TimedRows speedup_rows(bool with_gravity) {
  TimedRows rows = {{three_digits("speedup.step", times, "speedup: step", "over one thread or rank, timed in turn"),
                     [](Timed t) { return t.speedup.step; }, has_speedup}};
  if (with_gravity)
    rows.push_back({three_digits("speedup.drift", times, "speedup: drift", "of the drift"),
                    [](Timed t) { return t.speedup.drift; }, has_speedup});
  rows.push_back({three_digits("speedup.events", times, "speedup: events", "of the events"),
                  [](Timed t) { return t.speedup.events; }, has_speedup});
  if (with_gravity)
    rows.push_back({three_digits("speedup.gravity", times, "speedup: gravity", "of the solves"),
                    [](Timed t) { return t.speedup.gravity; }, has_speedup});
  rows.push_back({three_digits("speedup.pair", times, "speedup: a pair", "of the yardstick"),
                  [](Timed t) { return t.speedup.pair; }, has_speedup});
  return rows;
}

TimedRows all_of(std::initializer_list<TimedRows> parts) {
  TimedRows all;
  for (const TimedRows& part : parts)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

TimedRows step_rows() {
  return all_of(
      {{{three_digits("ns_per_particle_step", ns, "per particle and step", "median of the repeats"),
         [](Timed t) { return t.ns_per_particle_step; }},
        {three_digits("split.drift", ns, "  drift", "motion and contacts"), [](Timed t) { return t.split.drift; }},
        {three_digits("split.advance", ns, "  advance", "of the epicycles' phases"),
         [](Timed t) { return t.split.advance; }},
        {three_digits("split.gravity", ns, "  gravity", "self-gravity"), [](Timed t) { return t.split.gravity; }},
        {three_digits("split.kick", ns, "  kick", "of the elements"), [](Timed t) { return t.split.kick; }}},
       phase_rows("drift_split", "  drift: "),
       {{three_digits("drift_over_pair", unit::none, "drift over a pair's time", "in units of the yardstick `pair_ns`"),
         [](Timed t) { return t.split.drift / t.yardsticks.pair_ns; }},
        {three_digits("ns_drift_per_collision", ns, "drift per contact", "drift over contacts"),
         [](Timed t) { return t.per_contact(t.split.drift); }},
        {three_digits("ns_events_per_collision", ns, "events for each contact", "events over contacts"),
         [](Timed t) { return t.per_contact(t.drift_split.events); }},
        {three_digits("collisions_per_particle_step", unit::none, "collisions per particle and step",
                      "faster than v_cut"),
         [](Timed t) { return 2.0 * t.per_particle_step(t.collisions); }},
        {three_digits("contacts_per_particle_step", unit::none, "contacts per particle and step", "fast and slow"),
         [](Timed t) { return 2.0 * t.per_particle_step(t.contacts); }}},
       count_rows(),
       rank_rows(),
       speedup_rows(true)});
}

TimedRows drift_rows() {
  return all_of(
      {{{three_digits("ns_per_particle_step", ns, "per particle and step", "median of the repeats"),
         [](Timed t) { return t.ns_per_particle_step; }},
        {three_digits("split.advance", ns, "  advance", "of the epicycles' phases"),
         [](Timed t) { return t.split.advance; }}},
       phase_rows("split", "  "),
       {{three_digits("drift_over_pair", unit::none, "step over a pair's time", "in units of the yardstick `pair_ns`"),
         [](Timed t) { return t.ns_per_particle_step / t.yardsticks.pair_ns; }},
        {three_digits("ns_per_collision", ns, "per contact", "whole time over contacts"),
         [](Timed t) { return t.per_contact(t.ns_per_particle_step); }},
        {three_digits("ns_events_per_collision", ns, "events for each contact", "events over contacts"),
         [](Timed t) { return t.per_contact(t.drift_split.events); }}},
       count_rows(),
       speedup_rows(false)});
}

using Step = const TimedStep&;
using Drift = const TimedDrift&;

std::vector<QuantityRow<TimedStep>> step_setting_rows() {
  return {
      {three_digits("dispersion_r_omega", unit::unnamed("r Ω"), "dispersion c_x", "of the state that is timed"),
       [](Step s) { return s.bench.dispersion_r_omega; }},
      {word("solver", "solver", "of gravity"), [](Step s) { return s.bench.choice.solver; }},
      {word("settings", "  its settings", "of the solver"), [](Step s) { return s.bench.choice.text; }},
      {{"kick_every", unit::none, "steps per kick", "of gravity"},
       [](Step s) { return static_cast<std::uint64_t>(s.bench.choice.settings.kick_every); }},
      {word("state", "state", "that is timed"), [](Step s) { return s.settings.state; },
       [](Step s) { return !s.settings.from.has_value(); }},
      {three_digits("preparation", unit::seconds, "preparation", "time to make or read the state"),
       [](Step s) { return s.bench.preparation_s; }},
      {word("from", "from", "the timed snapshot"), [](Step s) { return *s.settings.from; },
       [](Step s) { return s.settings.from.has_value(); }},
      {{"count", unit::none, "particles", "N"}, [](Step s) { return std::uint64_t{s.bench.timed.count}; }},
      {{"step_orbits", unit::unnamed("orbits"), "a step", "its length"}, [](Step s) { return s.bench.step_orbits; }},
      {{"threads", unit::none, "threads", "that were used"},
       [](Step) { return static_cast<std::uint64_t>(threads()); }},
      {{"repeats", unit::none, "repeats", "times measured"},
       [](Step s) { return static_cast<std::uint64_t>(s.settings.repeats); }},
      {{"steps", unit::none, "steps in each", "steps of a repeat"},
       [](Step s) { return static_cast<std::uint64_t>(s.bench.timed.steps); }}};
}

std::vector<QuantityRow<TimedDrift>> drift_setting_rows() {
  return {{three_digits("cost_per_orbit_us", unit::unnamed("us"), "per particle and orbit",
                        "the time of all steps of an orbit"),
           [](Drift d) { return 1e-3 * d.bench.timed.ns_per_particle_step / d.settings.step_orbits; }},
          {three_digits("ns_per_call", ns, "per finder call", "at the start of steps"),
           [](Drift d) { return d.bench.ns_per_call; }},
          {three_digits("calls_per_particle_step", unit::none, "finder calls", "per particle, at the start of a step"),
           [](Drift d) { return d.bench.calls_per_particle_step; }},
          {three_digits("collisions_per_particle_orbit", unit::none, "collisions per particle and orbit",
                        "faster than v_cut"),
           [](Drift d) {
             return 2.0 * d.bench.timed.per_particle_step(d.bench.timed.collisions) / d.settings.step_orbits;
           }},
          {three_digits("dispersion_r_omega", unit::unnamed("r Ω"), "dispersion c_x", "of the state that is timed"),
           [](Drift d) { return d.bench.dispersion_r_omega; }},
          {{"count", unit::none, "particles", "N"}, [](Drift d) { return std::uint64_t{d.bench.timed.count}; }},
          {{"step_orbits", unit::unnamed("orbits"), "a step", "its length"},
           [](Drift d) { return d.settings.step_orbits; }},
          {{"optical_depth", unit::none, "optical depth", "of the state"},
           [](Drift d) { return d.settings.optical_depth; }},
          {word("sizes", "sizes", "of the particles"), [](Drift d) { return d.sizes; }},
          {word("finder", "finder", "of collisions"), [](Drift d) { return d.settings.finder; }},
          {word("all_pairs", "all pairs", "true if every candidate pair is passed to the finder"),
           [](Drift d) { return d.settings.all_pairs; }},
          {{"threads", unit::none, "threads", "that were used"},
           [](Drift) { return static_cast<std::uint64_t>(threads()); }},
          {{"repeats", unit::none, "repeats", "times measured"},
           [](Drift d) { return static_cast<std::uint64_t>(d.settings.repeats); }},
          {{"steps", unit::none, "steps in each", "steps of a repeat"},
           [](Drift d) { return static_cast<std::uint64_t>(d.bench.timed.steps); }}};
}

} // namespace

Record record_of(const TimedStep& step) {
  assert(step.bench.timed.repeats > 0);
  return {joined(entries_of(step_rows(), step.bench.timed), entries_of(step_setting_rows(), step)), {}};
}

Record record_of(const TimedDrift& drift) {
  assert(drift.bench.timed.repeats > 0 && drift.settings.step_orbits > 0.0);
  return {joined(entries_of(drift_rows(), drift.bench.timed), entries_of(drift_setting_rows(), drift)), {}};
}

std::vector<Quantity> step_bench_quantities() {
  return joined(quantities_of(step_rows()), quantities_of(step_setting_rows()));
}

std::vector<Quantity> drift_bench_quantities() {
  return joined(quantities_of(drift_rows()), quantities_of(drift_setting_rows()));
}

} // namespace keeler::cli
