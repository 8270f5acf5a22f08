#include <keeler/runs/verify.hpp>

#include "run_folder.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/io/contacts.hpp>
#include <keeler/io/describe.hpp>
#include <keeler/io/series.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace keeler::runs {
namespace fs = std::filesystem;
namespace {

// Values that all files of a run must agree on; empty if the file does not have them.
struct Found {
  std::string motion;     // Scene::motion
  std::string state_hash; // at the end of the run
};

bool nearly_equal(double a, double b) {
  constexpr double rounding = 1e-12; // scene texts have all digits
  return std::abs(a - b) <= rounding * std::abs(b);
}

// The other finders can miss contacts, so that particles overlap.
bool forbids_overlap(const Scene& scene) {
  return scene.collisions.finder == "certified";
}

void require_fit(const Patch& patch, const Scene& scene, const std::string& file) {
  initial_conditions::require_possible(patch, file);
  if (std::adjacent_find(patch.ids.begin(), patch.ids.end()) != patch.ids.end())
    throw IoError(fmt::format("'{}' has two particles with one id", file));
  if (!nearly_equal(patch.orbital_frequency, scene.planet.orbital_frequency) ||
      !nearly_equal(patch.frequencies.kappa, scene.planet.frequencies.kappa) ||
      !nearly_equal(patch.frequencies.nu, scene.planet.frequencies.nu) ||
      !nearly_equal(patch.box.shear, scene.planet.frequencies.shear()))
    throw IoError(fmt::format("'{}' has other frequencies than the scene in it", file));
  if (patch.size() < scene.moonlets.size())
    throw IoError(fmt::format("'{}' has fewer particles than the scene in it has moonlets", file));
  if (patch.spins.empty() == scene.collisions.friction.has_value())
    throw IoError(fmt::format("'{}' and the scene in it do not agree whether particles have spins", file));
  if (forbids_overlap(scene))
    cells::require_no_overlap(patch, "'" + file + "'");
}

// Returns the particles of a checkpoint at the boundary where it was written.
Patch patch_of(const StoredRun& run) {
  const simulation::SimulationState& state = run.state;
  Patch patch = make_patch(state.particles, state.box, state.boundary_offset(), run.scene.planet.frequencies,
                           -0.5 * state.step_length);
  patch.orbital_frequency = run.scene.planet.orbital_frequency;
  patch.time_orbits = static_cast<double>(state.step) * run.scene.time.step;
  return patch;
}

void require_finite(simulation::SimulationState& state, const std::string& file) {
  const FieldTable table = state.fields();
  for (const Field& field : table.fields()) {
    if (field.type != FieldType::float64)
      continue;
    const auto* const values = static_cast<const double*>(field.data());
    const std::size_t count = field.rows() * field.components;
    if (!std::all_of(values, values + count, [](double value) { return std::isfinite(value); }))
      throw IoError(fmt::format("the field '{}' of '{}' has a number that is not finite", field.name, file));
  }
}

Found check_checkpoint(const std::string& file) {
  StoredRun run = load_checkpoint(file);
  require_finite(run.state, file);
  require_fit(patch_of(run), run.scene, file);
  return {run.scene.motion, state_hash(run.state, run.scene)};
}

Found check_snapshot(const std::string& file) {
  const io::Snapshot snapshot = io::read_snapshot(file);
  const Scene scene = scene::parse_stored_scene(snapshot.meta.scene, file);
  require_fit(snapshot.patch, scene, file);
  return {scene.motion, {}};
}

Found check_contacts(const std::string& file) {
  const io::ContactFile contacts = io::read_contacts(file);
  std::int64_t last = 0;
  for (const io::ContactRow& row : contacts.rows) {
    const bool finite = std::isfinite(row.time_orbits) && row.position.allFinite() && std::isfinite(row.normal_speed) &&
                        std::isfinite(row.tangential_speed);
    if (!finite || row.step < last || row.low_id >= row.high_id)
      throw IoError(fmt::format("row {} of '{}' is not a valid contact, or is out of order",
                                contacts.meta.first_row + (&row - contacts.rows.data()), file));
    last = row.step;
  }
  return {scene::parse_stored_scene(contacts.meta.scene, file).motion, {}};
}

// Steps must not decrease from row to row; in series.csv they must increase.
Found check_series(const std::string& file) {
  const io::SeriesTable table = io::read_series(file);
  const std::vector<double>& steps = table.columns.front();
  const bool one_per_step = fs::path(file).filename() == "series.csv";
  const auto follows = [&](double step, double last) { return one_per_step ? step > last : step >= last; };
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (!std::isfinite(steps[k]) || (k > 0 && !follows(steps[k], steps[k - 1])))
      throw IoError(fmt::format("line {} of '{}' is out of order", k + 2, file));
  return {};
}

Found check_scene(const std::string& file) {
  return {scene::parse_stored_scene(files::read_text(file), file).motion, {}};
}

Found check_summary(const std::string& file) {
  const auto json = json_of<nlohmann::json>(files::read_text(file));
  if (!json.is_object() || !json.contains("state_hash") || !json["state_hash"].is_string())
    throw IoError(fmt::format("'{}' is not the summary of a run", file));
  return {{}, json["state_hash"].get<std::string>()};
}

// Checks the complete lines: the last one may be incomplete, in a run that is in progress or was killed.
Found check_log(const std::string& file) {
  const std::string text = files::read_lines(file);
  std::size_t line = 0;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
    ++line;
    const auto json = json_of<nlohmann::json>(text.substr(begin, end - begin));
    if (!json.is_object() || !json.contains("event") || !json["event"].is_string())
      throw IoError(fmt::format("line {} of '{}' is not an event of a log", line, file));
  }
  return {};
}

struct Kind {
  const char* name;
  Found (*check)(const std::string& file);
};

constexpr Kind checkpoint = {"checkpoint", check_checkpoint}, snapshot = {"snapshot", check_snapshot},
               contacts = {"contacts", check_contacts}, series = {"series", check_series};

// Returns the kind by the name that a run gives the file, otherwise by its content.
Kind kind_of(const fs::path& file) {
  static const std::map<std::string, Kind> texts = {{"scene.toml", {"scene", check_scene}},
                                                    {"summary.json", {"summary", check_summary}},
                                                    {"log.jsonl", {"log", check_log}},
                                                    {"series.csv", series},
                                                    {"moonlets.csv", series},
                                                    {"impact_speeds.csv", series}};
  const std::string name = file.filename().string();
  if (const auto text = texts.find(name); text != texts.end())
    return text->second;
  if (RunFolder::is_run_file(name))
    return name.starts_with("snap") ? snapshot : name.starts_with("checkpoint") ? checkpoint : contacts;
  switch (io::describe_file(file).kind) {
  case io::FileKind::checkpoint:
    return checkpoint;
  case io::FileKind::snapshot:
    return snapshot;
  case io::FileKind::contacts:
    break;
  }
  return contacts;
}

struct Verified {
  VerifiedFile file;
  Found found;
};

Verified verify(const fs::path& path) {
  Verified verified{{path.string(), "file", {}, false}, {}};
  try {
    const Kind kind = kind_of(path);
    verified.file.kind = kind.name;
    verified.file.sealed = io::is_sealed(path);
    verified.found = kind.check(path.string());
  } catch (const Error& error) {
    verified.file.damage = error.what();
  }
  return verified;
}

// Reports files that disagree with scene.toml or the newest checkpoint: they belong to another run.
void compare(std::vector<Verified>& files) {
  std::string motion, hash;
  for (const Verified& verified : files) {
    if (verified.file.kind == "scene")
      motion = verified.found.motion;
    if (verified.file.kind == "checkpoint")
      hash = verified.found.state_hash; // the last one is the newest; empty if it is damaged
  }
  for (auto& [file, found] : files) {
    if (!file.damage.empty())
      continue;
    if (!motion.empty() && !found.motion.empty() && found.motion != motion)
      file.damage = fmt::format("the scene in '{}' has other physics than scene.toml beside it", file.file);
    if (!hash.empty() && file.kind == "summary" && found.state_hash != hash)
      file.damage = fmt::format("the state_hash in '{}' is not that of the newest checkpoint", file.file);
  }
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code gone;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, gone))
    entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

// A run in progress removes old checkpoints: a file that has disappeared meanwhile is not damaged.
std::vector<VerifiedFile> verify_run(const fs::path& folder) {
  std::vector<Verified> files;
  for (const fs::path& path : sorted_entries(folder)) {
    const std::string name = path.filename().string();
    if (!RunFolder::is_run_file(name))
      continue;
    Verified verified = verify(path);
    if (fs::exists(path))
      files.push_back(std::move(verified));
  }
  compare(files);
  std::vector<VerifiedFile> result;
  for (Verified& verified : files)
    result.push_back(std::move(verified.file));
  return result;
}

} // namespace

VerifiedFile verify_file(const fs::path& file) {
  return verify(file).file;
}

std::vector<VerifiedFile> verify_folder(const fs::path& folder) {
  std::vector<VerifiedFile> files;
  if (fs::exists(folder / "log.jsonl"))
    files = verify_run(folder);
  else
    for (const fs::path& run : sorted_entries(folder / "runs")) {
      std::vector<VerifiedFile> more = verify_run(run);
      files.insert(files.end(), more.begin(), more.end());
    }
  if (files.empty())
    throw IoError(
        fmt::format("'{}' holds no run, and no sweep or study with runs; name the folder of one", folder.string()));
  return files;
}

} // namespace keeler::runs
