#include "edited_scene.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <vector>

namespace keeler::runs {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

// Returns the lines of `text` that are not in `other`; both are resolved scenes, with one key per line.
std::vector<std::string> lines_beyond(const std::string& text, const std::string& other) {
  std::vector<std::string> lines = lines_of(text), others = lines_of(other), beyond;
  std::sort(others.begin(), others.end());
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(beyond),
               [&](const std::string& line) { return !std::binary_search(others.begin(), others.end(), line); });
  return beyond;
}

} // namespace

std::optional<EditedScene> EditedScene::in(const RunFolder& folder, const std::string& stored, const Scene& scene) {
  std::error_code unknown;
  if (!fs::exists(folder.scene(), unknown))
    return std::nullopt;
  std::string text = files::read_lines(folder.scene());
  if (text == stored || text == scene.resolved)
    return std::nullopt;
  return EditedScene(folder, std::move(text), scene);
}

void EditedScene::keep_apart() {
  std::error_code error;
  fs::path kept = folder_.path() / "scene_edited.toml";
  for (int number = 2; fs::exists(kept, error); ++number)
    kept = folder_.path() / fmt::format("scene_edited_{}.toml", number);
  fs::rename(file_, kept, error);
  if (error)
    throw IoError(
        fmt::format("cannot rename the edited '{}' to '{}': {}", file_.string(), kept.string(), error.message()));
  file_ = kept;
}

std::string EditedScene::notice(const fs::path& newest) const {
  const std::string ignored =
      fmt::format("'{}' was edited, but a run continues with the scene that it began with: ", folder_.scene().string());
  const std::string kept = file_ == folder_.scene() ? "" : fmt::format("the edited text is now '{}'; ", file_.string());
  const std::string begins_again = fmt::format("\"keeler run {} --from {} -o NEW_FOLDER\" starts a run of the edited "
                                               "scene from the newest snapshot",
                                               file_.string(), newest.string());
  try {
    const Scene edited = scene::parse_stored_scene(text_, file_.string());
    const std::vector<std::string> changed = lines_beyond(edited.resolved, scene_.resolved);
    if (changed.empty())
      return fmt::format("{}{}no key differs", ignored, kept);
    if (changed.size() == 1 && changed.front().starts_with("end = "))
      return fmt::format("{}{}\"keeler resume {} --until {:.10g}\" continues to the edited end", ignored, kept,
                         folder_.path().string(), static_cast<double>(edited.time.end_step) * edited.time.step);
    return fmt::format("{}{}{} ({})", ignored, kept, begins_again, fmt::join(changed, ", "));
  } catch (const UsageError& fault) {
    return fmt::format("{}{}it is not a valid scene ({})", ignored, kept, fault.what());
  }
}

} // namespace keeler::runs
