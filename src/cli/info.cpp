// keeler info: what is in a snapshot, a checkpoint or a file of contacts, or in a folder of results.
#include "command.hpp"
#include "folder_info.hpp"

#include <keeler/io/contacts.hpp>
#include <keeler/io/describe.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/state_hash.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>

namespace keeler {
namespace {

// What tells one file from another of its kind.
nlohmann::ordered_json describe_state(const std::string& path, FileKind kind) {
  nlohmann::ordered_json json;
  if (kind == FileKind::checkpoint) {
    const StoredRun run = load_checkpoint(path);
    json["state_hash"] = state_hash(run.state, run.scene);
    json["time_orbits"] = static_cast<double>(run.state.step) * run.scene.time.step;
    json["particle_count"] = run.state.particles.size();
  } else if (kind == FileKind::snapshot) {
    const Patch patch = read_snapshot(path).patch;
    json["time_orbits"] = patch.time_orbits;
    json["particle_count"] = patch.size();
  } else {
    const ContactFile contacts = read_contacts(path);
    json["contact_count"] = contacts.rows.size();
    if (!contacts.rows.empty()) {
      json["first_time_orbits"] = contacts.rows.front().time_orbits;
      json["last_time_orbits"] = contacts.rows.back().time_orbits;
    }
  }
  return json;
}

nlohmann::ordered_json describe(const std::string& path) {
  const FileDescription file = describe_file(path);
  nlohmann::ordered_json json;
  json["file"] = path;
  json["kind"] = file.kind == FileKind::checkpoint ? "checkpoint"
                 : file.kind == FileKind::snapshot ? "snapshot"
                                                   : "contacts";
  json["format_version"] = file.format_version;
  json.update(describe_state(path, file.kind));
  for (const FieldDescription& field : file.fields) {
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
      fmt::print("{:17} {}\n", key, json[key].is_string() ? json[key].get<std::string>() : json[key].dump());
  fmt::print("\n");
  for (const auto& [name, field] : json["fields"].items()) {
    const std::string shape =
        field.contains("value") ? "= " + field["value"].get<std::string>() : field["shape"].dump();
    fmt::print("{:28} {:8} {:24} {}\n", name, field["type"].get<std::string>(), shape,
               field["unit"].get<std::string>());
  }
  fmt::print("\n");
  for (const auto& [name, value] : json["attributes"].items())
    fmt::print("{:28} {}\n", name, value.get<std::string>());
}

} // namespace

void add_info(CLI::App& program, Action& action) {
  struct Options {
    std::string path;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App& command = *program.add_subcommand("info", "show what is in a file or a folder of results");
  command
      .add_option("FILE|DIR", options->path,
                  "a snapshot, a checkpoint or a file of contacts; the folder of a run, a sweep or a study")
      ->required()
      ->type_name("");
  command.add_flag("--json", options->json, "print it as JSON");
  examples_of(command, {"keeler info wakes", "keeler info wakes/snap_000030.hdf --json"});
  command.callback([options, &action] {
    action = [options] {
      const bool folder = std::filesystem::is_directory(options->path);
      const nlohmann::ordered_json json = folder ? describe_folder(options->path) : describe(options->path);
      if (options->json)
        fmt::print("{}\n", json.dump(2));
      else
        folder ? print_folder(json) : print_text(json);
      return ExitCode::done;
    };
  });
}

} // namespace keeler
