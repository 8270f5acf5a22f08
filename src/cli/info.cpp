// keeler info: describes a snapshot, a checkpoint, a file of contacts, or a folder of results.
#include "command.hpp"
#include "folder_info.hpp"
#include "print.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/io/contacts.hpp>
#include <keeler/io/describe.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/runs/verify.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

// Returns the numbers that identify a file among others of its kind.
nlohmann::ordered_json describe_state(const std::string& path, io::FileKind kind) {
  nlohmann::ordered_json json;
  if (kind == io::FileKind::checkpoint) {
    const runs::StoredRun run = runs::load_checkpoint(path);
    json["state_hash"] = runs::state_hash(run.state, run.scene);
    json["time_orbits"] = static_cast<double>(run.state.step) * run.scene.time.step;
    json["particle_count"] = run.state.particles.size();
  } else if (kind == io::FileKind::snapshot) {
    const Patch patch = io::read_snapshot(path).patch;
    json["time_orbits"] = patch.time_orbits;
    json["particle_count"] = patch.size();
  } else {
    const io::ContactFile contacts = io::read_contacts(path);
    json["contact_count"] = contacts.rows.size();
    if (!contacts.rows.empty()) {
      json["first_time_orbits"] = contacts.rows.front().time_orbits;
      json["last_time_orbits"] = contacts.rows.back().time_orbits;
    }
  }
  return json;
}

nlohmann::ordered_json describe(const std::string& path) {
  const io::FileDescription file = io::describe_file(path);
  nlohmann::ordered_json json;
  json["file"] = path;
  json["kind"] = file.kind == io::FileKind::checkpoint ? "checkpoint"
                 : file.kind == io::FileKind::snapshot ? "snapshot"
                                                       : "contacts";
  json["format_version"] = file.format_version;
  json.update(describe_state(path, file.kind));
  for (const io::FieldDescription& field : file.fields) {
    nlohmann::ordered_json entry = {
        {"type", field.type}, {"shape", field.shape}, {"unit", field.unit}, {"about", field.about}};
    if (!field.value.empty())
      entry["value"] = field.value;
    json["fields"][field.name] = entry;
  }
  json["attributes"] = file.attributes;
  json["scene"] = file.scene;
  return json;
}

void print_text(const nlohmann::ordered_json& json) {
  for (const char* key : {"file", "kind", "format_version", "state_hash", "time_orbits", "particle_count",
                          "contact_count", "first_time_orbits", "last_time_orbits"})
    if (json.contains(key))
      print("{:17} {}\n", key, json[key].is_string() ? json[key].get<std::string>() : json_text(json[key]));
  print("\n");
  for (const auto& [name, field] : json["fields"].items()) {
    const std::string shape =
        field.contains("value") ? "= " + field["value"].get<std::string>() : json_text(field["shape"]);
    print("{:28} {:8} {:24} {}\n", name, field["type"].get<std::string>(), shape, field["unit"].get<std::string>());
  }
  print("\n");
  for (const auto& [name, value] : json["attributes"].items())
    print("{:28} {}\n", name, value.get<std::string>());
}

nlohmann::ordered_json as_json(const std::string& path, const std::vector<runs::VerifiedFile>& files) {
  nlohmann::ordered_json json = {{"path", path}, {"damaged", 0}, {"files", nlohmann::ordered_json::array()}};
  for (const runs::VerifiedFile& file : files) {
    json["files"].push_back({{"file", file.file}, {"kind", file.kind}, {"sealed", file.sealed}});
    json["files"].back()["damage"] =
        file.damage.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(file.damage);
    if (!file.damage.empty())
      json["damaged"] = json["damaged"].get<int>() + 1;
  }
  return json;
}

bool may_have_seal(const runs::VerifiedFile& file) {
  return file.kind == "snapshot" || file.kind == "checkpoint" || file.kind == "contacts";
}

void print_verified(const runs::VerifiedFile& file) {
  const std::string verdict = !file.damage.empty()                  ? "damaged: " + printable_line(file.damage)
                              : file.sealed || !may_have_seal(file) ? "whole"
                                                                    : "whole as far as can be told without a seal";
  print("{:<11} {:<32} {}\n", file.kind, fs::path(file.file).filename().string(), verdict);
}

// Prints one line per file. Throws IoError if any file is damaged.
ExitCode verify(const std::string& path, bool json) {
  const std::vector<runs::VerifiedFile> files =
      fs::is_directory(path) ? runs::verify_folder(path) : std::vector<runs::VerifiedFile>{runs::verify_file(path)};
  if (json)
    print("{}\n", json_text(as_json(path, files), 2));
  else
    for (const runs::VerifiedFile& file : files)
      print_verified(file);
  const auto damaged = [](const runs::VerifiedFile& file) { return !file.damage.empty(); };
  const auto first = std::find_if(files.begin(), files.end(), damaged);
  if (first == files.end())
    return ExitCode::done;
  throw IoError(files.size() == 1
                    ? first->damage
                    : fmt::format("{} of {} files are damaged, the first: {}",
                                  std::count_if(files.begin(), files.end(), damaged), files.size(), first->damage));
}

} // namespace

void add_info(CLI::App& program, Action& action) {
  struct Options {
    std::string path;
    bool json = false, verify = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App& command = *program.add_subcommand("info", "describe a file or a folder of results");
  command
      .add_option("FILE|DIR", options->path,
                  "a snapshot, a checkpoint or a file of contacts; the folder of a run, a sweep or a study")
      ->required()
      ->type_name("");
  command.add_flag("--json", options->json, "print the content as JSON");
  command.add_flag("--verify", options->verify,
                   "check that each file is whole: seal, checksums, format, scene against state, ids, overlaps, "
                   "finite numbers; exit code 4 if one is damaged");
  examples_of(command, {"keeler info wakes", "keeler info wakes/snap_000030.hdf --json", "keeler info --verify wakes"});
  command.callback([options, &action] {
    action = [options] {
      if (options->verify)
        return verify(options->path, options->json);
      const bool folder = fs::is_directory(options->path);
      const nlohmann::ordered_json json = folder ? describe_folder(options->path) : describe(options->path);
      if (options->json)
        print("{}\n", json_text(json, 2));
      else
        folder ? print_folder(json) : print_text(json);
      return ExitCode::done;
    };
  });
}

} // namespace keeler::cli
