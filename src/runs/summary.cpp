#include "summary.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/files/files.hpp>
#include <keeler/scene/doubts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

nlohmann::ordered_json work_of_forces(const SimulationState& state, double joule) {
  nlohmann::ordered_json work = nlohmann::ordered_json::object();
  for (const ForceState& force : state.forces)
    work[force.name] = force.work * joule;
  return work;
}

nlohmann::ordered_json energies(const Simulation& simulation, const Scene& scene) {
  const SimulationState& state = simulation.state();
  const double joule = scene.planet.orbital_frequency * scene.planet.orbital_frequency; // per kg m² rad⁻²
  const double shear = scene.planet.frequencies.shear();
  const EnergyBalance b = simulation.balance();
  return {{"start", b.start * joule},
          {"now", b.energy * joule},
          {"translational_shear_work", shear * b.translational_flux * joule},
          {"collisional_shear_work", shear * b.collisional_flux * joule},
          {"kick_work", b.kick_work * joule},
          {"kick_work_of", work_of_forces(state, joule)},
          {"resting_work", b.resting_work * joule},
          {"lost_in_collisions", b.lost * joule},
          {"residual", b.residual * joule}};
}

nlohmann::ordered_json force_error(const ForceChecks& checks) {
  if (checks.count == 0)
    return nullptr;
  return {{"rms", checks.last_rms},
          {"worst_rms", checks.worst_rms},
          {"checks", checks.count},
          {"particles", checks.particles}};
}

nlohmann::ordered_json energy_balance(const std::optional<Transport>& t) {
  if (!t || !t->balance)
    return nullptr;
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  return {{"ratio", number(t->balance->value)},
          {"error", number(t->balance->error)},
          {"total_viscosity_m2_s", number(t->total->value)},
          {"since_orbit", t->since_orbit},
          {"until_orbit", t->until_orbit},
          {"steady", t->steady}};
}

// What a user must know of the results: empty where nothing is amiss.
std::vector<std::string> notes(const Scene& scene, double orbits) {
  if (const std::optional<SatellitePassage> passage = doubtful_passage(scene, 0.0, orbits))
    return {in_words(*passage)};
  return {};
}

} // namespace

std::optional<Transport> transport_of_run(const std::filesystem::path& series, const RingScale& scale,
                                          const std::function<void(const std::string&)>& notice) {
  try {
    const SeriesTable table = read_series(series);
    if (enough_rows(table)) // too few say nothing
      return transport(table, scale, {});
  } catch (const Error& error) {
    if (notice)
      notice(fmt::format("no balance of energy: {}", error.what()));
  }
  return std::nullopt;
}

bool says_finished(const std::filesystem::path& summary) {
  std::error_code unknown;
  if (!std::filesystem::exists(summary, unknown))
    return false;
  const nlohmann::json json = json_of<nlohmann::json>(read_text(summary));
  return json.is_object() && json.contains("finished") && json["finished"] == true;
}

nlohmann::ordered_json summarise(Simulation& simulation, const Scene& scene, const std::optional<Transport>& transport,
                                 const RunResult& result, const RunCost& cost, const Provenance& provenance) {
  const SimulationState& state = simulation.state();
  const double count = static_cast<double>(simulation.count()), orbits = simulation.orbits();
  const auto rate = [&](std::uint64_t n) {
    return orbits > 0.0 ? 2.0 * static_cast<double>(n) / (count * orbits) : 0.0;
  };
  const TimeSplit& split = simulation.time_split();
  const double passes =
      1e-9 * count * static_cast<double>(std::max<std::int64_t>(1, state.control.steps - cost.first_step));
  nlohmann::ordered_json json;
  json["finished"] = result.finished;
  json["state_hash"] = result.state_hash;
  json["time_orbits"] = orbits;
  json["steps"] = state.control.steps;
  json["particle_count"] = simulation.count();
  json["ranks"] = simulation.ranks().count();
  json["threads"] = threads();
  json["collisions_per_particle_orbit"] = rate(state.collisions.fast);
  json["slow_contacts_per_particle_orbit"] = rate(state.collisions.slow);
  const std::uint64_t contacts = state.collisions.fast + state.collisions.slow;
  json["unresolved_contacts_share"] =
      static_cast<double>(state.collisions.unresolved) / static_cast<double>(std::max<std::uint64_t>(1, contacts));
  json["resting_contacts"] = nullptr;
  if (scene.gravity && scene.gravity->carries())
    json["resting_contacts"] = state.resting.pairs.size();
  json["finder_gave_up"] = state.collisions.gave_up;
  json["largest_overlap"] = simulation.largest_overlap();
  json["force_error"] = force_error(cost.force_checks);
  json["notes"] = notes(scene, orbits);
  json["energy_j"] = energies(simulation, scene);
  json["energy_balance"] = energy_balance(transport);
  json["wall_s"] = cost.wall_s;
  json["cpu_s"] = cost.cpu_s;
  json["orbits_done"] = orbits - cost.first_orbit;
  json["peak_memory_mb"] = 1e-6 * peak_memory();
  json["split"] = {{"start_s", cost.start_s},
                   {"drift_s", split.drift},
                   {"gravity_s", split.force("gravity")},
                   {"resting_s", split.resting},
                   {"series_s", cost.output.series},
                   {"stresses_s", cost.output.stresses},
                   {"snapshots_s", cost.output.snapshots},
                   {"checkpoints_s", cost.output.checkpoints},
                   {"contacts_s", cost.output.contacts},
                   {"exchange_s", exchange_costs().seconds},
                   {"force_checks_s", cost.force_checks.seconds}};
  json["ns_per_particle_step"] = {{"drift", split.drift / passes},
                                  {"gravity", split.force("gravity") / passes},
                                  {"series", cost.output.series / passes}};
  for (const ForceSettings& force : scene.external_forces)
    json["split"][std::string(force.entry->table) + "_s"] = split.force(force.entry->table);
  json["provenance"] = provenance;
  return json;
}

} // namespace keeler
