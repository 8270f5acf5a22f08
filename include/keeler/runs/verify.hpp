// Whether files of results are whole and hold what can be: seal and checksums, format version, finite numbers within
// their ranges, ids, overlaps, and the scene against the state. For `keeler info --verify`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace keeler {

struct VerifiedFile {
  std::string file;    ///< its path
  std::string kind;    ///< "checkpoint", "snapshot", "contacts", "series", "scene", "summary" or "log"
  std::string damage;  ///< the first that was found, a line; empty where there is none
  bool sealed = false; ///< a seal vouches for every byte; texts have none, nor what another program has changed
};

/// A snapshot, a checkpoint, a file of contacts, or a text of a run by its name. Nothing is thrown for damage.
VerifiedFile verify_file(const std::filesystem::path& file);

/// All files of a run, which must also fit to each other; of a sweep or a study those of its runs. In the order of
/// their names. Throws IoError where there is no run in the folder.
std::vector<VerifiedFile> verify_folder(const std::filesystem::path& folder);

} // namespace keeler
