#include "study_folder.hpp"

#include <keeler/batch/run_folders.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/provenance.hpp>

#include <fmt/format.h>

#include <cassert>
#include <exception>
#include <fstream>

namespace keeler::study {
namespace {

namespace fs = std::filesystem;

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      return line.substr(line.find(':') + 2);
  return "unknown";
}

} // namespace

std::map<std::string, std::string> study_provenance(const std::vector<std::string>& arguments) {
  const io::Provenance p = io::collect_provenance(arguments);
  return {{"command", p.at("arguments")}, {"host", p.at("host")},   {"processor", processor()},
          {"compiler", p.at("compiler")}, {"flags", p.at("flags")}, {"commit", p.at("commit")}};
}

std::string made_by(const std::map<std::string, std::string>& made) {
  return fmt::format("Made by `{}` on {} ({}), {}, flags `{}`, commit {}.", made.at("command"), made.at("processor"),
                     made.at("host"), made.at("compiler"), made.at("flags"), made.at("commit"));
}

Json open_study_folder(const fs::path& folder, const Json& options,
                       const std::map<std::string, std::string>& provenance) {
  const fs::path file = folder / "study.json";
  if (!fs::exists(file)) {
    if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
      throw UsageError(
          fmt::format("'{}' is not empty and is not the folder of a study; name another folder", folder.string()));
    batch::make_folder(folder);
    Json begun = options;
    for (const auto& [key, value] : provenance)
      begun[key] = value;
    files::write_text(file, json_text(begun, 2) + "\n");
    return begun;
  }
  const Json before = json_of<Json>(files::read_text(file));
  for (const auto& [key, value] : options.items())
    if (!before.is_object() || !before.contains(key) || before[key] != value)
      throw UsageError(fmt::format("'{}' holds a study with another {} ({}); give the same options or name another "
                                   "folder",
                                   folder.string(), key,
                                   before.is_object() && before.contains(key) ? json_text(before[key]) : "none"));
  return before;
}

void draw_and_report(const std::function<bool()>& draw, const std::function<void(bool)>& report) {
  assert(draw && report);
  std::exception_ptr fault;
  bool drawn = false;
  try {
    drawn = draw();
  } catch (const IoError&) {
    fault = std::current_exception();
  }
  report(drawn);
  if (fault)
    std::rethrow_exception(fault);
}

} // namespace keeler::study
