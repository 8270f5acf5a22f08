#include "summarise.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/files/files.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/patch_units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::runs {
namespace {

namespace unit = quantities::unit;
using quantities::NamedNumbers, quantities::Quantity, quantities::QuantityRow, quantities::Record, quantities::Unknown,
    quantities::Value, quantities::of_digits, quantities::value_of, quantities::word, quantities::yes_or_no;
using SummaryRow = QuantityRow<SummarySource>;
using From = const SummarySource&;

constexpr quantities::Unit joules = unit::unnamed("J"), nanoseconds = unit::unnamed("ns"),
                           of_rms = unit::unnamed("of the rms acceleration");

double joule(From s) { // per kg m² rad⁻²
  return s.scene.planet.orbital_frequency * s.scene.planet.orbital_frequency;
}

const CollisionTally& collisions(From s) {
  return s.simulation.state().collisions;
}

// Returns contacts per particle and orbit; each contact counts for both particles.
Value rate(From s, std::uint64_t contacts) {
  const double orbits = s.simulation.orbits();
  return orbits > 0.0 ? 2.0 * static_cast<double>(contacts) / (static_cast<double>(s.simulation.count()) * orbits)
                      : 0.0;
}

double unresolved_fraction(From s) {
  const std::uint64_t contacts = collisions(s).fast + collisions(s).slow;
  return static_cast<double>(collisions(s).unresolved) / static_cast<double>(std::max<std::uint64_t>(1, contacts));
}

bool carries(From s) {
  return s.scene.gravity && s.scene.gravity->carries();
}

bool has_force_error(From s) {
  return s.cost.force_checks.count > 0;
}

bool has_balance(From s) {
  return s.transport && s.transport->balance;
}

// Returns the warnings on the results; empty if there are none.
std::vector<std::string> notes(From s) {
  constexpr double too_many = 0.1, omitted = 0.05; // a solver of all forces has smaller errors
  std::vector<std::string> all;
  if (const std::optional<forces::SatellitePassage> passage =
          advice::unresolved_passage(s.scene, 0.0, s.simulation.orbits()))
    all.push_back(advice::in_words(*passage));
  if (!carries(s) && unresolved_fraction(s) > too_many)
    all.push_back(fmt::format(
        "{} % of the contacts are slower than one kick of the pair's own gravity: kick more often for "
        "viscosities; where spheres rest on each other, gravity.resting_contacts = \"carried\" may take less "
        "time",
        format_number(100.0 * unresolved_fraction(s), 2)));
  if (collisions(s).gave_up > 0 || s.largest_overlap > 1e-8)
    all.push_back(fmt::format("the collision finder gave up on {} {}, and may have missed contacts",
                              collisions(s).gave_up, collisions(s).gave_up == 1 ? "search" : "searches"));
  if (const ForceChecks& checks = s.cost.force_checks; has_force_error(s) && checks.last_rms > omitted)
    all.push_back(
        fmt::format("omitted by the gravity solver: {} % of the rms acceleration (a mesh alone lacks the pull of near "
                    "neighbours, rings of images lack farther images; few particles feel little else)",
                    format_number(100.0 * checks.last_rms, 2)));
  return all;
}

std::vector<SummaryRow> end_rows() {
  return {
      {yes_or_no("finished", "finished", "true at the end, false after a stop"),
       [](From s) { return s.result.finished; }},
      {word("state_hash", "state", "fingerprint of the state, see `keeler info`"),
       [](From s) { return s.result.state_hash; }},
      {{"time", unit::orbits, "time", "since the run began"}, [](From s) { return s.simulation.orbits(); }},
      {{"steps", unit::none, "steps", "since the run began"},
       [](From s) { return static_cast<std::uint64_t>(s.simulation.state().control.steps); }},
      {{"particle_count", unit::none, "particles", "N"}, [](From s) { return s.simulation.count(); }},
      {{"ranks", unit::none, "ranks", "processes of the run"},
       [](From s) { return static_cast<std::uint64_t>(s.simulation.ranks().size()); }},
      {{"threads", unit::none, "threads", "per process"}, [](From) { return static_cast<std::uint64_t>(threads()); }},
      {of_digits(3, {"collisions_per_particle_orbit", unit::none, "collisions per particle and orbit",
                     "faster than v_cut, 2 n/(N orbits), since the run began"}),
       [](From s) { return rate(s, collisions(s).fast); }},
      {of_digits(3, {"slow_contacts_per_particle_orbit", unit::none, "slow contacts",
                     "contacts slower than v_cut, which are elastic"}),
       [](From s) { return rate(s, collisions(s).slow); }},
      {of_digits(3,
                 {"unresolved_contacts_share", unit::none, "unresolved contacts",
                  "fraction of the contacts that are slower than the speed from one kick of the pair's own gravity"}),
       [](From s) { return unresolved_fraction(s); }},
      {{"resting_contacts", unit::none, "resting pairs",
        "resting pairs at the end, which transmit the kicks; null where the scene does not treat them so"},
       [](From s) {
         return carries(s) ? Value(std::uint64_t{s.simulation.state().resting.pairs.size()}) : Value(Unknown{});
       }},
      {{"finder_gave_up", unit::none, "searches given up",
        "searches for a contact that did not converge; always 0 with the `certified` finder"},
       [](From s) { return collisions(s).gave_up; }},
      {of_digits(2, {"largest_overlap", unit::unnamed("of a radius sum"), "largest overlap",
                     "at the end, over the sum of the radii"}),
       [](From s) { return s.largest_overlap; }},
      {word("force_error", "error of gravity", "null without gravity and where it was not checked"),
       [](From s) { return Unknown{s.scene.gravity ? "it was not checked" : "there is none"}; },
       [](From s) { return !has_force_error(s); }},
      {of_digits(2, {"force_error.rms", of_rms, "error of gravity",
                     "rms error of the accelerations against the sum over all pairs and images, in the last check"}),
       [](From s) { return s.cost.force_checks.last_rms; }, has_force_error},
      {of_digits(2, {"force_error.worst_rms", of_rms, "  at worst", "in the worst check of this command"}),
       [](From s) { return s.cost.force_checks.worst_rms; }, has_force_error},
      {{"force_error.checks", unit::none, "", "checks of this command, which take at most 0.5 % of the time"},
       [](From s) { return static_cast<std::uint64_t>(s.cost.force_checks.count); },
       has_force_error},
      {{"force_error.particles", unit::none, "", "particles per check"},
       [](From s) { return s.cost.force_checks.particles; },
       has_force_error},
      {word("notes", "note", "warnings: events so far that make the results doubtful"),
       [](From s) { return notes(s); }}};
}

Value work_of_forces(From s) {
  NamedNumbers work;
  for (const simulation::ForceState& force : s.simulation.state().forces)
    work.emplace_back(force.name, force.work * joule(s));
  return work;
}

std::vector<SummaryRow> energy_rows() {
  return {
      {{"energy_j.start", joules, "energy of random motion: start",
        "Σ m (½c² + ½ν²z²) of the random motions, c the velocity beyond the shear, and energy of spins"},
       [](From s) { return s.balance.start * joule(s); }},
      {{"energy_j.now", joules, "energy of random motion: now", "as above, now"},
       [](From s) { return s.balance.energy * joule(s); }},
      {{"energy_j.translational_shear_work", joules, "  from the shear, by transport",
        "work of the shear on the stress of moving particles"},
       [](From s) { return s.scene.planet.frequencies.shear() * s.balance.translational_flux * joule(s); }},
      {{"energy_j.collisional_shear_work", joules, "  from the shear, by contacts",
        "work of the shear on the stress of contacts"},
       [](From s) { return s.scene.planet.frequencies.shear() * s.balance.collisional_flux * joule(s); }},
      {{"energy_j.kick_work", joules, "  by kicks", "work of all forces"},
       [](From s) { return s.balance.kick_work * joule(s); }},
      {word("energy_j.kick_work_of", "", "work of each force, under its name"), work_of_forces},
      {{"energy_j.resting_work", joules, "  by contacts at rest",
        "work of the impulses of contacts at rest along their lines of centres"},
       [](From s) { return s.balance.resting_work * joule(s); }},
      {{"energy_j.lost_in_collisions", joules, "  lost in collisions", "since the run began"},
       [](From s) { return s.balance.lost * joule(s); }},
      {of_digits(2, {"energy_j.residual", joules, "  rounding", "residual of the energy budget"}),
       [](From s) { return s.balance.residual * joule(s); }},
      {word("energy_balance", "", "loss over work of the shear; null where the series does not show it"),
       [](From) { return Unknown{}; }, [](From s) { return !has_balance(s); }},
      {of_digits(
           4, {"energy_balance.ratio", unit::none, "energy balance",
               "energy lost over the work of the shear on all stresses where the run is steady; 1 within its error"}),
       [](From s) { return value_of(std::optional(s.transport->balance->value)); }, has_balance},
      {of_digits(2, {"energy_balance.error", unit::none, "  its error", "standard error, by blocks"}),
       [](From s) { return value_of(std::optional(s.transport->balance->error)); }, has_balance},
      {{"energy_balance.total_viscosity", unit::viscosity, "  total viscosity", "by all three stresses"},
       [](From s) { return value_of(std::optional(s.transport->total->value)); },
       has_balance},
      {{"energy_balance.since_orbit", unit::unnamed("orbits"), "  since", "first orbit of the steady part"},
       [](From s) { return s.transport->since_orbit; },
       has_balance},
      {{"energy_balance.until_orbit", unit::unnamed("orbits"), "  until", "last orbit of that part"},
       [](From s) { return s.transport->until_orbit; },
       has_balance},
      {yes_or_no("energy_balance.steady", "  steady", "whether the run is steady there"),
       [](From s) { return s.transport->steady; }, has_balance}};
}

// Returns the number of particle steps of this command, in units of 10⁹: seconds over this are ns per particle and
// step.
double giga_particle_steps(From s) {
  const std::int64_t steps = std::max<std::int64_t>(1, s.simulation.state().control.steps - s.cost.first_step);
  return 1e-9 * static_cast<double>(s.simulation.count()) * static_cast<double>(steps);
}

std::vector<SummaryRow> cost_rows() {
  return {
      {{"peak_memory", unit::megabytes, "memory at most", "10⁶ bytes; null where the system does not say"},
       [](From) { return value_of(std::optional(1e-6 * peak_memory())); }},
      {{"cpu", unit::seconds, "processor time", "processor time of this command"}, [](From s) { return s.cost.cpu_s; }},
      {{"orbits_done", unit::unnamed("orbits"), "", "by this command"},
       [](From s) { return s.simulation.orbits() - s.cost.first_orbit; }},
      {{"wall", unit::seconds, "wall time", "wall time of this command"}, [](From s) { return s.cost.wall_s; }},
      {{"split.start", unit::seconds, "  start", "wall time of making or reading the initial state; 0 after a resume"},
       [](From s) { return s.cost.start_s; }},
      {{"split.drift", unit::seconds, "  drift", "of motion and contacts"},
       [](From s) { return s.simulation.time_split().drift; }},
      {{"split.gravity", unit::seconds, "  gravity", "of self-gravity"},
       [](From s) { return s.simulation.time_split().force("gravity"); }},
      {{"split.resting", unit::seconds, "", "of contacts at rest"},
       [](From s) { return s.simulation.time_split().resting; }},
      {of_digits(2, {"split.series", unit::seconds, "  series", "of rows of `series.csv`"}),
       [](From s) { return s.cost.output.series; }},
      {of_digits(2, {"split.stresses", unit::seconds, "  stresses", "of gravity's energy and stress in them"}),
       [](From s) { return s.cost.output.stresses; }},
      {of_digits(2, {"split.snapshots", unit::seconds, "  snapshots", "of snapshots"}),
       [](From s) { return s.cost.output.snapshots; }},
      {of_digits(2, {"split.checkpoints", unit::seconds, "  checkpoints", "of checkpoints"}),
       [](From s) { return s.cost.output.checkpoints; }},
      {{"split.contacts", unit::seconds, "", "of files of the log of contacts"},
       [](From s) { return s.cost.output.contacts; }},
      {{"split.exchange", unit::seconds, "  exchange of ranks",
        "sending, receiving and waiting of the first of several ranks; included in the other times"},
       [](From) { return comm::exchange_costs().seconds; }},
      {of_digits(2, {"split.force_checks", unit::seconds, "  checks of forces", "of the checks behind `force_error`"}),
       [](From s) { return s.cost.force_checks.seconds; }},
      {of_digits(3, {"ns_per_particle_step.drift", nanoseconds, "drift, per particle and step",
                     "wall time per particle and step"}),
       [](From s) { return s.simulation.time_split().drift / giga_particle_steps(s); }},
      {of_digits(3, {"ns_per_particle_step.gravity", nanoseconds, "gravity, per particle and step",
                     "wall time per particle and step"}),
       [](From s) { return s.simulation.time_split().force("gravity") / giga_particle_steps(s); }},
      {of_digits(2, {"ns_per_particle_step.series", nanoseconds, "series, per particle and step",
                     "wall time per particle and step"}),
       [](From s) { return s.cost.output.series / giga_particle_steps(s); }}};
}

std::vector<SummaryRow> summary_rows() {
  return joined(joined(end_rows(), energy_rows()), cost_rows());
}

} // namespace

std::optional<Transport> transport_of_run(const std::filesystem::path& series, const RingScale& scale,
                                          const std::function<void(const std::string&)>& notice) {
  try {
    const io::SeriesTable table = io::read_series(series);
    if (enough_rows(table))
      return transport(table, scale, {});
  } catch (const Error& error) {
    if (notice)
      notice(fmt::format("no balance of energy: {}", error.what()));
  }
  return std::nullopt;
}

bool says_finished(const std::filesystem::path& folder) {
  std::error_code unknown;
  if (!std::filesystem::exists(folder / "summary.json", unknown))
    return false;
  try {
    const Record summary = read_summary(folder);
    const Value* const finished = find_value(summary, "finished");
    return finished && std::holds_alternative<bool>(*finished) && std::get<bool>(*finished);
  } catch (const IoError&) { // the run will rewrite a damaged one
    return false;
  }
}

Record summarise(Simulation& simulation, const Scene& scene, const std::optional<Transport>& transport,
                 const RunResult& result, const RunCost& cost, const io::Provenance& provenance) {
  assert(cost.first_step <= simulation.state().control.steps && cost.wall_s >= 0.0);
  const SummarySource source{simulation,          scene, transport, result, cost, simulation.largest_overlap(),
                             simulation.balance()};
  const simulation::SimulationState& state = simulation.state();
  Record record{entries_of(summary_rows(), source),
                units_of(state.particles, state.box.area(), scene.planet.orbital_frequency, simulation.ranks())};
  for (const scene::ForceSettings& force : scene.external_forces)
    record.entries.push_back({{fmt::format("split.{}", force.entry->table), unit::seconds},
                              simulation.time_split().force(force.entry->table)});
  for (const auto& [name, value] : provenance)
    record.entries.push_back({word("provenance." + name, "", ""), value});
  return record;
}

std::vector<Quantity> summary_quantities() {
  return quantities_of(summary_rows());
}

Record read_summary(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "summary.json";
  const auto json = json_of<nlohmann::ordered_json>(files::read_text(file));
  if (!json.is_object())
    throw IoError(
        fmt::format("'{}' is not the summary of a run (it is damaged); restore it, or remove it", file.string()));
  try {
    return record_of(json, summary_quantities());
  } catch (const UsageError& fault) {
    throw IoError(fmt::format("'{}' holds something else than Keeler writes there ({}); restore it, or make it again",
                              file.string(), fault.what()));
  }
}

} // namespace keeler::runs
