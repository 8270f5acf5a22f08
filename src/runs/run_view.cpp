#include <keeler/runs/run_view.hpp>

#include "run_folder.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/runs/folder_lock.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>
#include <sstream>

namespace keeler::runs {
namespace {

namespace fs = std::filesystem;

// Returns the time of a line of the log, s since 1970; none if it is missing or malformed.
std::optional<double> seconds_of(const nlohmann::json& line) {
  const auto found = line.find("time");
  std::tm utc = {};
  if (found == line.end() || !found->is_string() ||
      strptime(found->get_ref<const std::string&>().c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc) == nullptr)
    return std::nullopt;
  return static_cast<double>(timegm(&utc));
}

// Returns the value of a key, or `fallback` if it is missing or has another type.
template<class Value> Value value_in(const nlohmann::json& line, const char* key, const Value& fallback) {
  try {
    return line.value(key, fallback);
  } catch (const nlohmann::json::exception&) {
    return fallback;
  }
}

void apply_event(RunView& view, const nlohmann::json& line) {
  const std::string event = view.last_event = value_in(line, "event", std::string());
  if (event == "started" || event == "resumed") {
    if (view.end_missing)
      view.ended_s.reset();
    view.end_missing = true;
    view.end_orbits = value_in(line, "end_orbits", 0.0);
    view.first_orbits = value_in(line, "orbits", 0.0);
    view.began_s = seconds_of(line);
    view.particles = value_in(line, "particles", view.particles);
  } else if (event == "finished" || event == "stopped" || event == "broken" || event == "given up") {
    view.end_missing = false;
    const std::optional<double> now = seconds_of(line);
    if (view.ended_s && view.began_s && now)
      *view.ended_s += *now - *view.began_s;
    else
      view.ended_s.reset();
  }
}

// Reads all events; incomplete lines and lines that are not JSON objects are skipped.
void read_log(RunView& view, const fs::path& file) {
  std::istringstream lines(files::read_lines(file));
  for (std::string text; std::getline(lines, text);) {
    const nlohmann::json line = json_of<nlohmann::json>(text);
    if (line.is_object())
      apply_event(view, line);
  }
}

// Returns the newest of numbered files: the longest name, and the last one of that length.
std::string newest_name(const fs::path& folder, const std::string& prefix, const std::string& ending) {
  std::string newest;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool later = name.size() != newest.size() ? name.size() > newest.size() : name > newest;
    if (name.starts_with(prefix) && name.ends_with(ending) && later)
      newest = name;
  }
  return newest;
}

} // namespace

double RunView::completed_fraction() const {
  return end_orbits > 0.0 ? std::clamp(orbits / end_orbits, 0.0, 1.0) : 0.0;
}

std::string RunView::state() const {
  if (running)
    return "running";
  const bool ended = last_event == "finished" || last_event == "stopped" || last_event == "broken";
  return ended ? last_event : "not running";
}

std::optional<double> RunView::wall_s(double now_s) const {
  if (!ended_s || !end_missing)
    return ended_s;
  return running && began_s ? std::optional(*ended_s + now_s - *began_s) : std::nullopt;
}

std::optional<double> RunView::remaining_s(double now_s) const {
  constexpr double min_s = 2.0; // the log has whole seconds
  if (!running || !began_s || !(orbits > first_orbits) || now_s - *began_s < min_s)
    return std::nullopt;
  return (now_s - *began_s) / (orbits - first_orbits) * std::max(end_orbits - orbits, 0.0);
}

RunView view_run(const fs::path& path) {
  const RunFolder folder(path);
  if (!fs::exists(folder.log()))
    throw IoError(fmt::format("no run in '{}' (log.jsonl is missing); name the folder of a run{}", path.string(),
                              folder.runs_inside()));
  RunView view;
  view.running = folder_is_held(path);
  read_log(view, folder.log());
  if (fs::exists(folder.series()))
    view.series = io::read_series(folder.series());
  if (const std::vector<double>* times = view.series.find("time_orbits"); times && !times->empty())
    view.orbits = times->back();
  view.snapshot = newest_name(path, "snap_", ".hdf");
  view.checkpoint = newest_name(path, "checkpoint_", ".h5");
  view.picture = newest_name(path, "picture", ".png");
  return view;
}

} // namespace keeler::runs
