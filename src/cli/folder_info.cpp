#include "folder_info.hpp"

#include "print.hpp"

#include <keeler/batch/run_folders.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/describe.hpp>
#include <keeler/runs/folder_lock.hpp>
#include <keeler/runs/run_stage.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// Returns the size of a file, 0 if a working run has removed it.
std::uintmax_t size_of(const fs::path& file) {
  std::error_code gone;
  const std::uintmax_t size = fs::file_size(file, gone);
  return gone ? 0 : size;
}

std::uintmax_t size_of_all(const fs::path& folder) {
  std::uintmax_t size = 0;
  std::error_code gone;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, gone))
    if (entry.is_regular_file(gone))
      size += size_of(entry.path());
  return size;
}

// Returns the files of a folder with this beginning and ending of their names, sorted.
std::vector<fs::path> files_named(const fs::path& folder, const std::string& beginning, const std::string& ending) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(beginning) && name.ends_with(ending))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Returns nothing for a damaged file.
std::optional<io::FileDescription> description_of(const fs::path& file) {
  try {
    return io::describe_file(file);
  } catch (const IoError&) {
    return std::nullopt;
  }
}

// Returns the number in a text, or null: files of other programs may hold anything.
Json number_in(const std::string& text) {
  const Json number = json_of<Json>(text);
  return number.is_number() ? number : Json(nullptr);
}

// As above, but always a floating-point number.
Json real_number_in(const std::string& text) {
  const Json number = number_in(text);
  return number.is_number() ? Json(number.get<double>()) : number;
}

// Returns an empty text if the file has no such attribute.
std::string attribute_of(const io::FileDescription& file, const std::string& name) {
  const auto found = file.attributes.find(name);
  return found == file.attributes.end() ? "" : found->second;
}

Json value_of_field(const io::FileDescription& file, const std::string& name) {
  for (const io::FieldDescription& field : file.fields)
    if (field.name == name)
      return field.value.empty() ? Json(field.shape.front()) : number_in(field.value);
  return nullptr;
}

// Adds the number that identifies a file: the time of a snapshot, the step of a checkpoint, the rows of contacts.
void add_mark(Json& line, const std::optional<io::FileDescription>& file) {
  line["damaged"] = !file;
  if (!file)
    return;
  if (file->kind == io::FileKind::snapshot)
    line["time_orbits"] = real_number_in(attribute_of(*file, "RingBox/time_orbits"));
  else if (file->kind == io::FileKind::checkpoint)
    line["steps"] = value_of_field(*file, "steps");
  else
    line["contact_count"] = value_of_field(*file, "Step");
}

// Adds the version, commit, host and threads of the program that wrote a file.
void add_writer(Json& json, const io::FileDescription& file) {
  const std::string group = file.kind == io::FileKind::checkpoint ? "provenance/" : "Code/";
  for (const char* const name : {"version", "commit", "host"})
    if (const std::string value = attribute_of(file, group + name); !value.empty())
      json[name] = value;
  json["threads"] = number_in(attribute_of(file, group + "threads"));
}

// Returns one entry per file. The last undamaged file sets the writer in `json`.
Json files_of(Json& json, const fs::path& folder, const std::string& beginning, const std::string& ending) {
  Json lines = Json::array();
  for (const fs::path& path : files_named(folder, beginning, ending)) {
    const std::optional<io::FileDescription> file = description_of(path);
    if (!fs::exists(path))
      continue; // a working run removed it: it keeps two checkpoints
    Json line = {{"file", path.filename().string()}, {"bytes", size_of(path)}};
    add_mark(line, file);
    lines.push_back(line);
    if (file)
      add_writer(json, *file);
  }
  return lines;
}

Json describe_run(const fs::path& folder) {
  const runs::RunView view = runs::view_run(folder);
  const auto now = static_cast<double>(std::time(nullptr));
  const fs::path scene = folder / "scene.toml";
  Json json = {{"folder", folder.string()}, {"kind", "run"}, {"state", view.state()}};
  json["title"] = fs::exists(scene) ? scene::load_stored_scene(scene).title : "";
  json["particle_count"] = view.particles;
  json["time_orbits"] = view.orbits;
  json["end_orbits"] = view.end_orbits;
  json["remaining_s"] = or_null(view.remaining_s(now));
  json["wall_s"] = or_null(view.wall_s(now));
  for (const char* const name : {"version", "commit", "host", "threads"})
    json[name] = nullptr;
  json["bytes"] = size_of_all(folder);
  json["snapshots"] = files_of(json, folder, "snap_", ".hdf");
  json["checkpoints"] = files_of(json, folder, "checkpoint_", ".h5");
  json["contacts"] = files_of(json, folder, "collisions_", ".h5");
  json["series"] = {
      {"rows", view.series.rows()}, {"columns", view.series.names.size()}, {"bytes", size_of(folder / "series.csv")}};
  return json;
}

const char* stage_of(const fs::path& run) {
  if (runs::folder_is_held(run))
    return "running";
  switch (runs::run_stage(run)) {
  case runs::RunStage::finished:
    return "finished";
  case runs::RunStage::resumable:
    return "resumable";
  case runs::RunStage::begun:
    return "begun";
  case runs::RunStage::absent:
    break;
  }
  return "empty";
}

// Counts the runs of a sweep or a study by stage.
Json runs_of(const batch::RunFolders& folders) {
  Json runs = Json::object();
  for (const char* const stage : {"finished", "running", "resumable", "begun", "empty", "failed"})
    runs[stage] = 0;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folders.path() / "runs", none)) {
    const bool failed = folders.failure_of(entry.path().filename().string()).has_value();
    Json& count = runs[failed ? "failed" : stage_of(entry.path())];
    count = count.get<int>() + 1;
  }
  return runs;
}

Json names_of_files(const fs::path& folder) {
  Json names = Json::array();
  for (const fs::path& file : files_named(folder, "", ""))
    if (fs::is_regular_file(file) && file.filename() != "claims")
      names.push_back(file.filename().string());
  return names;
}

Json describe_many(const fs::path& folder) {
  const fs::path study = folder / "study.json";
  Json json = {{"folder", folder.string()}, {"kind", fs::exists(study) ? "study" : "sweep"}};
  if (fs::exists(study)) {
    const Json begun = json_of<Json>(files::read_text(study));
    json["study"] = begun.is_object() && begun.contains("study") ? begun["study"] : Json(nullptr);
  }
  if (fs::is_directory(folder / "runs"))
    json["runs"] = runs_of(batch::RunFolders(folder));
  json["files"] = names_of_files(folder);
  json["bytes"] = size_of_all(folder);
  return json;
}

std::string size_in_words(const Json& bytes) {
  const auto size = bytes.get<double>();
  return size < 1e6 ? fmt::format("{:.3g} kB", 1e-3 * size) : fmt::format("{} MB", format_number(1e-6 * size, 4));
}

std::string in_words(const Json& value) {
  return value.is_string()   ? value.get<std::string>()
         : value.is_number() ? format_number(value.get<double>())
                             : "unknown";
}

// Prints number and size of the files of one kind, and one line per file.
void print_files(const char* what, const Json& files, const char* mark, const char* unit) {
  std::uintmax_t bytes = 0;
  for (const Json& file : files)
    bytes += file["bytes"].get<std::uintmax_t>();
  print("{:<12}{}{}\n", what, files.size(), files.empty() ? "" : ", " + size_in_words(bytes));
  for (const Json& file : files)
    print("  {:<24}{:<20}{}\n", file["file"].get<std::string>(),
          file["damaged"].get<bool>() ? "damaged" : fmt::format("{} {}", unit, in_words(file[mark])),
          size_in_words(file["bytes"]));
}

std::string clock(const Json& seconds) {
  if (seconds.is_null())
    return "not known";
  const auto whole = static_cast<long>(seconds.get<double>());
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

void print_run(const Json& json) {
  const auto text = [&](const char* key) { return json[key].get<std::string>(); };
  const std::string state = text("state");
  print("folder      {}\ntitle       {}\n", text("folder"), text("title"));
  print("state       {}{}\n", state,
        state == "finished"           ? std::string()
        : state == "running"          ? ", " + clock(json["remaining_s"]) + " left"
        : state == "broken"           ? ": log.jsonl has the reason, broken_*.hdf the state"
        : json["checkpoints"].empty() ? "; no checkpoint: \"keeler run --force\" starts it again"
                                      : "; \"keeler resume " + text("folder") + "\" continues");
  print("orbits      {} of {}\n", format_number(json["time_orbits"].get<double>(), 4),
        format_number(json["end_orbits"].get<double>(), 4));
  print("particles   {}\nwall time   {}\n", json["particle_count"].get<std::uint64_t>(), clock(json["wall_s"]));
  if (!json["version"].is_null())
    print("written by  keeler {}, commit {}, {} on {}\n", in_words(json["version"]), in_words(json["commit"]),
          json["threads"].is_number_unsigned() ? pluralize(json["threads"].get<std::uint64_t>(), "thread")
                                               : "unknown threads",
          in_words(json["host"]));
  print("on disk     {}\n", size_in_words(json["bytes"]));
  print_files("snapshots", json["snapshots"], "time_orbits", "orbit");
  print_files("checkpoints", json["checkpoints"], "steps", "step");
  if (!json["contacts"].empty())
    print_files("contacts", json["contacts"], "contact_count", "rows:");
  print("series      {} of {}, {}\n", pluralize(json["series"]["rows"].get<std::uint64_t>(), "row"),
        pluralize(json["series"]["columns"].get<std::uint64_t>(), "column"), size_in_words(json["series"]["bytes"]));
}

void print_many(const Json& json) {
  print("folder      {}\nkind        {}", json["folder"].get<std::string>(), json["kind"].get<std::string>());
  if (const auto study = json.find("study"); study != json.end() && study->is_string())
    print(", {}", study->get<std::string>());
  print("\non disk     {}\n", size_in_words(json["bytes"]));
  if (json.contains("runs"))
    for (const auto& [stage, count] : json["runs"].items())
      if (count.get<int>() > 0)
        print("runs        {} {}\n", count.get<int>(), stage);
  for (const Json& name : json["files"])
    print("file        {}\n", name.get<std::string>());
}

} // namespace

Json describe_folder(const fs::path& folder) {
  if (fs::exists(folder / "log.jsonl"))
    return describe_run(folder);
  if (fs::exists(folder / "study.json") || fs::exists(folder / "claims"))
    return describe_many(folder);
  throw IoError(fmt::format("'{}' holds no run, sweep or study (no log.jsonl, claims or study.json is in it); name the "
                            "folder of one",
                            folder.string()));
}

void print_folder(const Json& json) {
  if (json["kind"] == "run")
    print_run(json);
  else
    print_many(json);
}

} // namespace keeler::cli
