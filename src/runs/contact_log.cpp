#include "contact_log.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace keeler::runs {
namespace {

const std::vector<std::string> speed_columns = {"since_orbits", "until_orbits", "speed_from_m_s",
                                                "speed_to_m_s", "contacts",     "energy_lost_j"};

// Rows are written at snapshots only, so a resumed run cuts off the rows after its last snapshot and writes them again.
io::Series open_speeds(const RunFolder& folder, const std::optional<LogResume>& resume) {
  return resume ? io::Series::resume(folder.impact_speeds(), speed_columns, resume->last_snapshot_step)
                : io::Series::begin(folder.impact_speeds(), speed_columns);
}

} // namespace

void ContactCounters::list_fields(FieldTable& table) {
  table.scalar("contacts_logged", rows, "1", "rows of the log of contacts");
  speeds.list_fields(table);
}

bool is_logged(const scene::ContactLogSettings& settings, const collision::CollisionRecord& record, double time_orbits,
               double orbital_frequency) {
  if (record.normal_speed * orbital_frequency < settings.min_speed || record.radius_sum < settings.min_radius_sum)
    return false;
  if (settings.fraction >= 1.0)
    return true;
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15; // combines both ids into one number
  RandomStream random(std::bit_cast<std::uint64_t>(time_orbits), RandomPurpose::contact,
                      odd * record.low_id + record.high_id);
  return random.uniform() < settings.fraction;
}

ContactLog::ContactLog(const RunFolder& folder, const Scene& scene, const io::Provenance& provenance,
                       const std::optional<LogResume>& resume, std::int64_t file_rows)
    : folder_(folder), scene_(scene), provenance_(provenance), file_rows_(file_rows),
      counters_(resume ? resume->counters : ContactCounters{}), speeds_(open_speeds(folder, resume)) {
  assert(file_rows > 0 && counters_.rows >= 0);
  if (resume)
    load_last_file();
  write_all(); // so that a run without write access fails before its first step
}

// Loads the rows of the last file, up to the number in the checkpoint. If the file is missing or damaged, the table
// continues with a gap.
void ContactLog::load_last_file() {
  const std::int64_t number = counters_.rows / file_rows_;
  folder_.cut_contacts(number + 1);
  first_row_ = number * file_rows_;
  if (first_row_ == counters_.rows)
    return;
  try {
    io::ContactFile file = io::read_contacts(folder_.contacts(number));
    const std::int64_t wanted = counters_.rows - file.meta.first_row;
    if (file.meta.first_row >= first_row_ && wanted >= 0 && wanted <= static_cast<std::int64_t>(file.rows.size())) {
      first_row_ = file.meta.first_row;
      rows_ = std::move(file.rows);
      rows_.resize(static_cast<std::size_t>(wanted));
      return;
    }
  } catch (const IoError&) {
    // missing or damaged
  }
  lost_rows_ = counters_.rows - first_row_;
  first_row_ = counters_.rows;
}

void ContactLog::watch(Simulation& simulation) {
  simulation_ = &simulation;
  simulation.drift().observe(this);
}

void ContactLog::recorded(std::span<const collision::CollisionRecord> records) {
  assert(simulation_ != nullptr && scene_.output.collisions);
  const double omega = scene_.planet.orbital_frequency;
  const simulation::SimulationState& state = simulation_->state();
  const std::int64_t step = state.step;
  const double middle = static_cast<double>(step) + 0.5 * static_cast<double>(state.control.step);
  for (const collision::CollisionRecord& record : records) {
    counters_.speeds.add(record.normal_speed * omega, record.energy_lost * omega * omega);
    const double time = middle * scene_.time.step + record.time / two_pi;
    if (!is_logged(*scene_.output.collisions, record, time, omega))
      continue;
    rows_.push_back({step, time, record.contact_point, record.low_id, record.high_id, record.image,
                     record.normal_speed * omega, record.tangential_speed * omega, record.fast, record.normal,
                     record.impulse * omega});
    ++counters_.rows;
  }
}

MembersAtRest members_at_rest(const Scene& scene, Simulation& simulation) {
  const simulation::SimulationState& state = simulation.state();
  MembersAtRest members;
  if (!scene.output.collisions->at_rest || state.resting.pairs.empty())
    return members;
  const std::int64_t interval = state.control.kick > 0 ? state.control.kick : scene.gravity->kick_every;
  if (state.step % interval != 0)
    return members;
  for (const contact_solver::RestingPair& pair : state.resting.pairs)
    members.ids.insert(members.ids.end(), {pair.low, pair.high});
  std::sort(members.ids.begin(), members.ids.end());
  members.ids.erase(std::unique(members.ids.begin(), members.ids.end()), members.ids.end());
  members.bodies = simulation.bodies_of(members.ids);
  return members;
}

void ContactLog::add_contacts_at_rest(const MembersAtRest& members) {
  assert(simulation_ != nullptr && scene_.output.collisions);
  if (members.ids.empty())
    return;
  const scene::ContactLogSettings& settings = *scene_.output.collisions;
  const simulation::SimulationState& state = simulation_->state();
  const contact_solver::RestingState& resting = state.resting;
  const auto body_of = [&](std::uint64_t id) -> const Body& {
    const auto found = std::lower_bound(members.ids.begin(), members.ids.end(), id);
    return members.bodies[static_cast<std::size_t>(found - members.ids.begin())];
  };
  const forces::Boundary boundary = simulation_->boundary();
  const auto position = [&](const Body& body) {
    return state_at(body.elements, boundary.frequencies, boundary.rotation()).position;
  };
  const double omega = scene_.planet.orbital_frequency, time = static_cast<double>(state.step) * scene_.time.step;
  for (std::size_t k = 0; k < resting.pairs.size(); ++k) {
    const auto [low, high] = resting.pairs[k];
    const Body &body = body_of(low), &other = body_of(high);
    const double radius = body.radius;
    collision::CollisionRecord record{};
    record.low_id = low, record.high_id = high;
    record.radius_sum = radius + other.radius;
    if (!is_logged(settings, record, time, omega))
      continue;
    const Vec3 separation = resting.loads[k].separation, normal = separation.normalized(), at = position(body);
    const Vec3 shift = separation - (position(other) - at);
    record.image.nx = static_cast<std::int32_t>(std::lround(shift.x() / boundary.box.size_x));
    record.image.ny =
        static_cast<std::int32_t>(std::lround((shift.y() + record.image.nx * boundary.offset) / boundary.box.size_y));
    rows_.push_back({.step = state.step,
                     .time_orbits = time,
                     .position = at + radius * normal,
                     .low_id = low,
                     .high_id = high,
                     .image = record.image,
                     .normal = normal,
                     .impulse = resting.loads[k].impulse * omega * normal,
                     .at_rest = true});
    ++counters_.rows;
  }
}

void ContactLog::write_full_files() {
  for (std::int64_t end; (end = (first_row_ / file_rows_ + 1) * file_rows_) <= counters_.rows;) {
    const auto full = static_cast<std::size_t>(end - first_row_);
    write_file(full);
    rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(full));
    first_row_ = end;
  }
}

void ContactLog::write_all() {
  write_full_files();
  if (written_ != counters_.rows)
    write_file(rows_.size());
  speeds_.sync();
}

void ContactLog::write_file(std::size_t rows) {
  assert(rows <= rows_.size() && rows <= static_cast<std::size_t>(file_rows_));
  write_contacts(folder_.contacts(first_row_ / file_rows_), std::span(rows_).first(rows),
                 {first_row_, scene_.planet.orbital_frequency, scene_.resolved, provenance_});
  written_ = first_row_ + static_cast<std::int64_t>(rows);
}

void ContactLog::end_interval(std::int64_t last_snapshot_step, std::int64_t step) {
  const double since = static_cast<double>(std::max<std::int64_t>(last_snapshot_step, 0)) * scene_.time.step;
  const double until = static_cast<double>(step) * scene_.time.step;
  assert(last_snapshot_step <= step);
  ImpactSpeeds& speeds = counters_.speeds;
  for (std::size_t bin = 0; bin < speeds.bins(); ++bin)
    if (speeds.count(bin) > 0)
      speeds_.append(step, std::vector<double>{since, until, speeds.lower_edge(bin), speeds.upper_edge(bin),
                                               static_cast<double>(speeds.count(bin)), speeds.energy_lost(bin)});
  speeds.clear();
}

} // namespace keeler::runs
