#include "recorder.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/simd.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/force_error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/gravity/direct.hpp>
#include <keeler/io/checkpoint.hpp>
#include <keeler/io/checkpoint_folder.hpp>
#include <keeler/io/snapshot.hpp>

#include <algorithm>

#include <fcntl.h>

namespace keeler {
namespace {

constexpr std::size_t checked_particles = 200;

const std::vector<std::string> series_columns = {
    "time_orbits",       "dispersion_x_m_s",      "dispersion_y_m_s", "dispersion_z_m_s", "scale_height_m",
    "collisions",        "slow_contacts",         "energy_lost_j",    "kick_work_j",      "edge_work_j",
    "energy_residual_j", "momentum_flux_kg_m2_s", "largest_overlap"};

Series open_series(const RunFolder& folder, std::optional<std::int64_t> resumed_at) {
  return resumed_at ? Series::resume(folder.series(), series_columns, *resumed_at)
                    : Series::begin(folder.series(), series_columns);
}

} // namespace

void OutputCounters::list_fields(FieldTable& table) {
  table.scalar("snapshots_written", snapshots, "1", "number of the next snapshot");
  table.scalar("checkpoints_written", checkpoints, "1", "number of the next checkpoint");
  table.scalar("last_snapshot_step", last_snapshot_step, "1", "step of the newest snapshot");
}

Recorder::Recorder(const RunFolder& folder, const Scene& scene, const std::vector<std::string>& arguments,
                   OutputCounters counters, std::optional<std::int64_t> resumed_at)
    : folder_(folder), orbital_frequency_(scene.planet.orbital_frequency), scene_text_(scene.resolved),
      provenance_(collect_provenance(arguments)), counters_(counters), series_(open_series(folder, resumed_at)) {
  write_text(folder_.scene(), scene_text_);
}

void Recorder::snapshot(const Simulation& simulation) {
  const Stopwatch watch(seconds_);
  write_snapshot(folder_.snapshot(counters_.snapshots), simulation.patch(), {scene_text_, provenance_});
  ++counters_.snapshots;
  counters_.last_snapshot_step = simulation.state().step;
}

void Recorder::checkpoint(const Simulation& simulation) {
  const Stopwatch watch(seconds_);
  series_.sync();
  SimulationState copy = simulation.state();
  OutputCounters counters = counters_;
  ++counters.checkpoints;
  FieldTable table = copy.fields();
  counters.list_fields(table);
  write_checkpoint(checkpoint_path(folder_.path(), counters_.checkpoints), table, {scene_text_, provenance_});
  counters_ = counters;
  prune_checkpoints(folder_.path());
}

void Recorder::sample(const Simulation& simulation) {
  const Stopwatch watch(seconds_);
  const Patch patch = simulation.patch();
  const SimulationState& state = simulation.state();
  const double omega = patch.orbital_frequency, joule = omega * omega; // per kg m² rad⁻²
  const Vec3 c = velocity_dispersion(patch) * omega;
  const double edges = state.energy.wrap_work + state.collisions.edge_work;
  const double values[] = {simulation.orbits(),
                           c.x(),
                           c.y(),
                           c.z(),
                           scale_height(patch),
                           static_cast<double>(state.collisions.fast),
                           static_cast<double>(state.collisions.slow),
                           state.collisions.energy_lost * joule,
                           state.kick_work() * joule,
                           edges * joule,
                           simulation.energy_residual() * joule,
                           state.collisions.momentum_flux * omega,
                           largest_overlap(patch).depth};
  series_.append(state.step, values);
}

void Recorder::check_forces(const Simulation& simulation) {
  ForceChecks& c = force_checks_;
  c.last_s = 0.0;
  {
    const Stopwatch watch(c.last_s);
    std::vector<Vec3> positions;
    std::vector<double> masses;
    const GravityProblem problem = gravity_problem(simulation.boundary(), orbital_frequency_, positions, masses);
    const ForceSample sample = draw_force_sample(problem, checked_particles, 0, 0.0);
    const std::vector<Vec3> exact =
        sampled_accelerations(problem, sample.targets, {.rings = 2}, choose_instruction_set());
    const ForceErrors errors = force_errors(sample, exact, simulation.state().forces.front().accelerations);
    ++c.count;
    c.particles = sample.even;
    c.last_step = simulation.state().step;
    c.last_rms = errors.rms;
    c.worst_rms = std::max(c.worst_rms, errors.rms);
    log("force_error", {{"step", c.last_step}, {"rms", errors.rms}, {"largest", errors.p999}});
  }
  c.seconds += c.last_s;
  seconds_ += c.last_s;
}

void Recorder::log(const std::string& event, const nlohmann::ordered_json& details) {
  nlohmann::ordered_json line;
  line["event"] = event;
  line.update(details);
  const std::string text = line.dump() + "\n";
  Descriptor file(folder_.log(), O_WRONLY | O_CREAT | O_APPEND);
  file.write_all(std::as_bytes(std::span(text)));
  file.close();
}

} // namespace keeler
