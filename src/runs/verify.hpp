// Verification of result files, for `keeler info --verify`: seal and checksums, format version, finite numbers within
// their ranges, ids, overlaps, and the scene against the state.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace keeler::runs {

struct VerifiedFile {
  std::string file;    ///< path of the file
  std::string kind;    ///< "checkpoint", "snapshot", "contacts", "series", "scene", "summary" or "log"
  std::string damage;  ///< description of the first damage found; empty if there is none
  bool sealed = false; ///< a seal covers every byte; text files and files changed by other programs have none
};

/// Verifies a snapshot, a checkpoint, a file of contacts, or a text file of a run, known by its name. Damage is
/// reported, never thrown.
VerifiedFile verify_file(const std::filesystem::path& file);

/// Verifies all files of a run, in the order of their names, and their consistency with each other; in the folder of a
/// sweep or a study, the files of all its runs. Throws IoError when the folder holds no run.
std::vector<VerifiedFile> verify_folder(const std::filesystem::path& folder);

} // namespace keeler::runs
