// What is fuzzed: functions that hand bytes to one reader each. A reader takes them or throws keeler::Error; anything
// else that it does is a finding. The same functions are run by libFuzzer (fuzz.cpp) and over the corpus (replay.cpp).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace keeler::fuzz {

/// The target may write its files in this folder, which is empty but for what it left there itself.
using Run = void (*)(std::string_view input, const std::filesystem::path& folder);

void read_scene(std::string_view input, const std::filesystem::path& folder);
void read_assignments(std::string_view input, const std::filesystem::path& folder);
void read_radii(std::string_view input, const std::filesystem::path& folder);
void read_table(std::string_view input, const std::filesystem::path& folder);
void read_series_file(std::string_view input, const std::filesystem::path& folder);
void read_edited_snapshot(std::string_view input, const std::filesystem::path& folder);
void read_edited_checkpoint(std::string_view input, const std::filesystem::path& folder);
void read_foreign_here(std::string_view input, const std::filesystem::path& folder);
void read_foreign(std::string_view input, const std::filesystem::path& folder);
void resume_folder(std::string_view input, const std::filesystem::path& folder);

struct Target {
  std::string_view name; ///< of its corpus too
  Run fuzzed, replayed;
  unsigned changed; ///< how many changed inputs the replay makes: few where each makes files, processes or a run
};

/// Files of other programs are read in the fuzzer's own process, where it sees what the reader does, and replayed
/// through the child process, which may break.
inline constexpr Target targets[] = {
    {"scene", read_scene, read_scene, 300},
    {"set", read_assignments, read_assignments, 300},
    {"radii", read_radii, read_radii, 300},
    {"table", read_table, read_table, 300},
    {"series", read_series_file, read_series_file, 300},
    {"snapshot", read_edited_snapshot, read_edited_snapshot, 100},
    {"checkpoint", read_edited_checkpoint, read_edited_checkpoint, 100},
    {"foreign", read_foreign_here, read_foreign, 50},
    {"folder", resume_folder, resume_folder, 50},
};

/// The target of that name, or null.
inline const Target* find_target(std::string_view name) {
  for (const Target& target : targets)
    if (target.name == name)
      return &target;
  return nullptr;
}

/// Runs a target on an input: an Error is its right to throw.
void run(Run target, std::string_view input, const std::filesystem::path& folder);

/// A file as anybody else would write it: nothing is forced to disk.
void put(const std::filesystem::path& file, std::string_view content);

/// A scene of eight particles that every target may use.
std::string small_scene();

/// A new folder of this process for the files of targets, in $KEELER_FUZZ_FOLDER where that is set.
std::filesystem::path make_folder();

} // namespace keeler::fuzz
