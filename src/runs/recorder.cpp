#include "recorder.hpp"

#include "invariants.hpp"
#include "reference_forces.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/diagnostics/force_error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/forces/self_gravity.hpp>
#include <keeler/gravity/near_image_count.hpp>
#include <keeler/io/checkpoint.hpp>
#include <keeler/io/checkpoint_folder.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/quantities/views.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string_view>
#include <utility>

#include <fcntl.h>

namespace keeler::runs {
namespace {

// Returns the number of particles of a force check: fewer in a long box, where each exact sum has thousands of images.
std::size_t checked_particles(const ShearingBox& box, const gravity::ImageSettings& images) {
  constexpr std::size_t max_count = 128, min_count = 8, images_of_square_box = 25;
  return std::clamp(max_count * images_of_square_box / near_image_count(box, images), min_count, max_count);
}

io::Series open_series(const std::filesystem::path& file, const std::vector<std::string>& columns, const Scene& scene,
                       std::optional<std::int64_t> resumed_at) {
  if (!resumed_at)
    return io::Series::begin(file, columns);
  const std::int64_t every = scene.output.series_every; // 0: only the row at the start
  return io::Series::resume(file, columns, *resumed_at, every > 0 ? every : *resumed_at + 1);
}

// Returns the columns of an existing series: one begun by an earlier version has fewer, and keeps them.
std::vector<SeriesColumn> columns_to_continue(const std::filesystem::path& file,
                                              const std::vector<SeriesColumn>& columns) {
  const std::vector<std::string> names = io::series_names(file);
  std::vector<SeriesColumn> present;
  std::copy_if(columns.begin(), columns.end(), std::back_inserter(present), [&](const SeriesColumn& column) {
    return std::find(names.begin(), names.end(), column.name) != names.end();
  });
  return !names.empty() && names_of(present) == names ? present : columns;
}

} // namespace

void OutputCounters::list_fields(FieldTable& table, const Scene& scene) {
  table.scalar("snapshots_written", snapshots, "1", "number of the next snapshot");
  table.scalar("checkpoints_written", checkpoints, "1", "number of the next checkpoint");
  table.scalar("last_snapshot_step", last_snapshot_step, "1", "step of the newest snapshot");
  if (scene.output.collisions)
    contacts.list_fields(table);
}

Recorder::Recorder(const RunFolder& folder, const FolderLock* lock, const Scene& scene,
                   const std::vector<std::string>& arguments, OutputCounters counters,
                   std::optional<std::int64_t> resumed_at, Notice notice, const Communicator& ranks)
    : folder_(folder), lock_(lock), ranks_(ranks), scene_(scene), provenance_(io::collect_provenance(arguments)),
      counters_(std::move(counters)), notice_(std::move(notice)), all_columns_(series_columns_of(scene)),
      columns_(all_columns_), moonlet_columns_(moonlet_columns_of(scene)) {
  assert((lock != nullptr) == ranks.is_root());
  ranks_.on_root([&] { open(resumed_at); });
}

void Recorder::open(std::optional<std::int64_t> resumed_at) {
  if (resumed_at)
    columns_ = columns_to_continue(folder_.series(), columns_);
  series_.emplace(open_series(folder_.series(), names_of(columns_), scene_, resumed_at));
  if (!moonlet_columns_.empty()) {
    std::vector<std::string> names;
    for (const MoonletColumn& column : moonlet_columns_)
      names.emplace_back(column.name);
    moonlets_.emplace(open_series(folder_.moonlets(), names, scene_, resumed_at));
  }
  files::write_text(folder_.scene(), scene_.resolved);
  if (!scene_.output.collisions)
    return;
  std::optional<LogResume> resume;
  if (resumed_at)
    resume = LogResume{counters_.contacts, counters_.last_snapshot_step};
  contact_log_.emplace(folder_, scene_, provenance_, resume);
}

void Recorder::notify(const std::string& text) const {
  if (notice_)
    notice_(text);
}

void Recorder::report_restored(io::Series& series, const std::filesystem::path& file) {
  if (!series.take_restored())
    return;
  write_log("restored", {{"file", file.filename().string()}});
  notify(fmt::format("'{}' was removed or replaced while the run wrote to it; it is rewritten with all its rows",
                     file.string()));
}

void Recorder::report_restored() {
  report_restored(*series_, folder_.series());
  if (moonlets_)
    report_restored(*moonlets_, folder_.moonlets());
  if (contact_log_)
    report_restored(contact_log_->speeds(), folder_.impact_speeds());
}

void Recorder::report_lost_rows(const io::Series& series, const std::filesystem::path& file) {
  if (series.gaps().empty())
    return;
  const io::SeriesGap first = series.gaps().front();
  const std::size_t others = series.gaps().size() - 1;
  for (const io::SeriesGap& gap : series.gaps())
    write_log("rows lost", {{"file", file.filename().string()}, {"from_step", gap.from}, {"to_step", gap.to}});
  notify(fmt::format("the rows of '{}' from step {} to {}{} are missing; the file continues without them",
                     file.string(), first.from, first.to,
                     others > 0 ? fmt::format(", and {} more,", pluralize(others, "gap")) : ""));
}

void Recorder::report_losses() {
  ranks_.on_root([&] { report_losses_on_root(); });
}

void Recorder::report_losses_on_root() {
  report_lost_rows(*series_, folder_.series());
  if (moonlets_)
    report_lost_rows(*moonlets_, folder_.moonlets());
  if (!contact_log_)
    return;
  if (const std::int64_t lost = contact_log_->lost_rows(); lost > 0) {
    write_log("contacts lost", {{"rows", lost}});
    notify(fmt::format("the last {} rows of the log of contacts are missing or damaged; the log continues without them",
                       lost));
  }
}

void Recorder::watch(Simulation& simulation) {
  if (contact_log_)
    contact_log_->watch(simulation);
  else if (scene_.output.collisions)
    simulation.drift().observe(&record_requester_);
}

void Recorder::contacts(Simulation& simulation) {
  if (!scene_.output.collisions)
    return;
  const Stopwatch watch(costs_.contacts);
  const MembersAtRest members = members_at_rest(scene_, simulation);
  ranks_.on_root([&] {
    contact_log_->add_contacts_at_rest(members);
    contact_log_->write_full_files();
  });
}

void Recorder::require_sound(const simulation::SimulationState& state, const diagnostics::ParticleMeans& means) {
  ranks_.together([&] {
    if (const std::string fault = fault_of_budget(state, means, scene_.planet.frequencies); !fault.empty())
      throw InvariantError(fault);
  });
  sound_step_ = state.step;
}

// Checks once per step: a row of the series makes the check with its own means, and later outputs reuse it.
void Recorder::require_sound(const Simulation& simulation) {
  if (simulation.state().step != sound_step_)
    require_sound(simulation.state(), simulation.means());
}

void Recorder::snapshot(const Simulation& simulation) {
  const Stopwatch watch(costs_.snapshots);
  require_sound(simulation);
  std::optional<io::SnapshotFile> file;
  ranks_.on_root([&] {
    file.emplace(folder_.snapshot(counters_.snapshots), simulation.frame(), simulation.count(),
                 simulation.state().particles.rough, io::SnapshotMeta{scene_.resolved, provenance_});
  });
  simulation.visit_patch(io::SnapshotFile::piece, [&](const Patch& piece) { file->add(piece); });
  ranks_.on_root([&] {
    file->finish();
    if (contact_log_)
      contact_log_->end_interval(counters_.last_snapshot_step, simulation.state().step);
    report_restored();
  });
  ++counters_.snapshots;
  counters_.last_snapshot_step = simulation.state().step;
}

void Recorder::checkpoint(const Simulation& simulation) {
  ranks_.on_root([&] { lock_->require_in_place(); });
  require_sound(simulation);
  if (scene_.output.collisions) {
    const Stopwatch watch(costs_.contacts);
    ranks_.on_root([&] {
      contact_log_->write_all();
      counters_.contacts = contact_log_->counters();
    });
  }
  const Stopwatch watch(costs_.checkpoints);
  ranks_.on_root([&] {
    series_->sync();
    if (moonlets_)
      moonlets_->sync();
    report_restored();
  });
  OutputCounters counters = counters_;
  ++counters.checkpoints;
  FieldTable table = simulation.state().fields();
  counters.list_fields(table, scene_);
  assert(counters.checkpoints > 0 && counters.snapshots >= 0);
  const std::filesystem::path file = io::checkpoint_path(folder_.path(), counters_.checkpoints);
  io::write_checkpoint(file, table, {scene_.resolved, provenance_}, ranks_);
  ranks_.on_root([&] {
    lock_->require_in_place();
    io::remove_later_checkpoints(file);
    io::prune_checkpoints(file);
  });
  counters_ = counters;
}

void Recorder::sample(const Simulation& simulation) {
  const std::optional<gravity::GravityEnergy> gravity = measure_gravity(simulation);
  const Stopwatch watch(costs_.series);
  const SeriesSample row(scene_, simulation, gravity);
  require_sound(simulation.state(), row.means);
  std::vector<std::vector<double>> moonlets(simulation.state().moonlets.size());
  for (std::size_t k = 0; k < moonlets.size(); ++k)
    for (const MoonletColumn& column : moonlet_columns_)
      moonlets[k].push_back(column.value({scene_, simulation, k}));
  const std::vector<double> values = values_of(all_columns_, row); // an own column may be collective
  ranks_.on_root([&] { append(row, values, moonlets); });
}

// `values` are of all columns; a file that an earlier version began may lack some.
void Recorder::append(const SeriesSample& row, const std::vector<double>& values,
                      const std::vector<std::vector<double>>& moonlets) {
  const std::int64_t step = row.simulation.state().step;
  assert(moonlets.empty() || moonlets_);
  lock_->require_in_place();
  std::vector<double> written;
  for (std::size_t k = 0, column = 0; k < all_columns_.size() && column < columns_.size(); ++k)
    if (std::string_view(all_columns_[k].name) == columns_[column].name) {
      written.push_back(values[k]);
      ++column;
    }
  assert(written.size() == columns_.size());
  series_->append(step, written);
  for (const std::vector<double>& of_moonlet : moonlets)
    moonlets_->append(step, of_moonlet);
  report_restored();
}

// Measures in the first row at or after each multiple of stress_every. The schedule depends on the step alone, so
// restarts do not change it.
std::optional<gravity::GravityEnergy> Recorder::measure_gravity(const Simulation& simulation) {
  const std::int64_t step = simulation.state().step, every = scene_.output.stress_every;
  if (!measures_gravity(scene_) || (step > 0 && step / every == (step - scene_.output.series_every) / every))
    return std::nullopt;
  const Stopwatch watch(costs_.stresses);
  return simulation.gravity_energy();
}

void Recorder::check_forces(const Simulation& simulation) {
  assert(scene_.gravity && !simulation.state().forces.empty());
  ForceChecks& c = force_checks_;
  c.last_s = 0.0;
  {
    const Stopwatch watch(c.last_s);
    std::vector<Vec3> positions;
    std::vector<double> masses;
    const gravity::GravityProblem problem =
        gravity_problem(simulation.boundary(), scene_.planet.orbital_frequency, positions, masses);
    const gravity::ImageSettings images = reference_images(*scene_.gravity);
    const std::vector<std::size_t> places =
        diagnostics::draw_force_places(simulation.count(), checked_particles(problem.box, images));
    const ComparedForces compared =
        compare_forces(problem, simulation.state().forces.front().accelerations, places, *scene_.gravity, images);
    diagnostics::ForceSample sample;
    sample.uniform = places.size();
    sample.targets.resize(places.size());
    std::iota(sample.targets.begin(), sample.targets.end(), std::size_t{0});
    const diagnostics::ForceErrors errors = force_errors(sample, compared.exact, compared.found);
    ++c.count;
    c.particles = places.size();
    c.last_step = simulation.state().step;
    c.last_rms = errors.rms;
    c.worst_rms = std::max(c.worst_rms, errors.rms);
    log("force_error", {{"step", c.last_step}, {"rms", errors.rms}, {"largest", errors.p999}});
  }
  c.seconds += c.last_s;
}

void Recorder::summary(const quantities::Record& summary) {
  ranks_.on_root([&] { files::write_text(folder_.summary(), json_text(json_of(summary), 2) + "\n"); });
}

void Recorder::log(const std::string& event, const nlohmann::ordered_json& details) {
  ranks_.on_root([&] { write_log(event, details); });
}

void Recorder::write_log(const std::string& event, const nlohmann::ordered_json& details) {
  assert(ranks_.is_root() && lock_ != nullptr);
  lock_->require_in_place();
  nlohmann::ordered_json line;
  line["event"] = event;
  line.update(details);
  line["time"] = io::utc_now();
  const std::string text = json_text(line) + "\n";
  files::Descriptor file(folder_.log(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  lock_->require_in_place();
  file.append_whole(std::as_bytes(std::span(text)));
  file.close();
}

} // namespace keeler::runs
