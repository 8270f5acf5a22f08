#include "run_folder.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <regex>

namespace keeler {
namespace fs = std::filesystem;
namespace {

const std::regex
    own_file(R"((snap_\d{6,}\.hdf|checkpoint_\d{6,}\.h5|scene\.toml|series\.csv|summary\.json|log\.jsonl)(\.tmp)?)");

} // namespace

fs::path RunFolder::snapshot(std::int64_t number) const {
  return path_ / fmt::format("snap_{:06}.hdf", number);
}

void RunFolder::claim(bool force) const {
  try {
    fs::create_directories(path_);
    if (fs::is_empty(path_))
      return;
    if (!force)
      throw UsageError(
          fmt::format("'{}' is not empty (a run never overwrites another); name another folder, continue that "
                      "run with \"keeler resume\", or add --force to replace it",
                      path_.string()));
    for (const fs::directory_entry& entry : fs::directory_iterator(path_))
      if (std::regex_match(entry.path().filename().string(), own_file))
        fs::remove(entry.path());
  } catch (const fs::filesystem_error& error) {
    throw IoError(fmt::format("cannot make the folder '{}': {}", path_.string(), error.code().message()));
  }
}

void RunFolder::cut_snapshots(std::int64_t from_number) const {
  std::error_code ignored; // what cannot be removed will be replaced
  for (std::int64_t number = from_number; fs::exists(snapshot(number)); ++number)
    fs::remove(snapshot(number), ignored);
}

} // namespace keeler
