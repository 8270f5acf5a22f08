#include <keeler/io/checkpoint_folder.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/io/checkpoint.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <optional>

namespace keeler::io {
namespace {

constexpr std::string_view prefix = "checkpoint_", ending = ".h5";

// Returns the number in checkpoint_NNNNNN.h5, if this is such a name.
std::optional<std::int64_t> number_of(std::string_view name) {
  if (name.size() <= prefix.size() + ending.size() || !name.starts_with(prefix) || !name.ends_with(ending))
    return std::nullopt;
  std::int64_t number = 0;
  const char* last = name.data() + name.size() - ending.size();
  const auto [end, error] = std::from_chars(name.data() + prefix.size(), last, number);
  if (error != std::errc{} || end != last)
    return std::nullopt;
  return number;
}

// Lists the checkpoints in a folder, highest number first.
std::vector<std::filesystem::path> list(const std::filesystem::path& folder) {
  std::vector<std::pair<std::int64_t, std::filesystem::path>> found;
  try {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (const auto number = number_of(entry.path().filename().string()))
        found.emplace_back(*number, entry.path());
  } catch (const std::filesystem::filesystem_error& error) {
    throw IoError(fmt::format("cannot list folder '{}': {}", folder.string(), error.code().message()));
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<std::filesystem::path> files;
  for (auto& [number, file] : found)
    files.push_back(std::move(file));
  return files;
}

void remove_file(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error)
    throw IoError(fmt::format("cannot remove '{}': {}", file.string(), error.message()));
}

} // namespace

std::filesystem::path checkpoint_path(const std::filesystem::path& folder, std::int64_t number) {
  assert(number >= 0);
  return folder / fmt::format("{}{:06}{}", prefix, number, ending);
}

std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder) {
  return list(folder);
}

NewestCheckpoint newest_valid_checkpoint(const std::filesystem::path& folder) {
  NewestCheckpoint newest;
  for (const std::filesystem::path& file : list_checkpoints(folder)) {
    try {
      const Checkpoint verified(file);
      newest.path = file;
      return newest;
    } catch (const IoError& error) {
      newest.warnings.push_back(error.what());
    }
  }
  if (newest.warnings.empty())
    throw IoError(
        fmt::format("there is no checkpoint in '{}' (a run that ends before its first one leaves none); start "
                    "again with \"keeler run\" and --force",
                    folder.string()));
  throw IoError(
      fmt::format("no checkpoint in '{}' can be used: {}", folder.string(), fmt::join(newest.warnings, "; ")));
}

void prune_checkpoints(const std::filesystem::path& newest, std::size_t keep) {
  assert(keep >= 1);
  const std::vector<std::filesystem::path> files = list_checkpoints(newest.parent_path());
  const auto at = static_cast<std::size_t>(std::find(files.begin(), files.end(), newest) - files.begin());
  for (std::size_t k = at + keep; k < files.size(); ++k)
    remove_file(files[k]);
  files::remove_left_overs(newest.parent_path(), [](std::string_view name) { return number_of(name).has_value(); });
}

void remove_later_checkpoints(const std::filesystem::path& newest) {
  for (const std::filesystem::path& file : list_checkpoints(newest.parent_path())) {
    if (file == newest)
      return;
    remove_file(file);
  }
}

} // namespace keeler::io
