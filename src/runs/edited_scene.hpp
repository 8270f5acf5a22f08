// A scene.toml that was edited after a run wrote it. A resumed run goes on with the scene of its checkpoint and writes
// scene.toml again, so the edited text is kept under another name, and the user hears what would do as it says.
#pragma once

#include "run_folder.hpp"

#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace keeler {

class EditedScene {
public:
  /// Returns none where scene.toml is missing, or holds the scene as the run wrote it: `stored`, the text in the
  /// checkpoint, or what this program makes of that. Throws IoError.
  static std::optional<EditedScene> in(const RunFolder& folder, const std::string& stored, const Scene& scene);

  /// Gives scene.toml the first name of scene_edited.toml, scene_edited_2.toml … that is free, for a run that goes on.
  /// Throws IoError.
  void keep_apart();

  /// Returns a line: what is ignored, where it is, and the command for it. `newest` is the newest snapshot.
  std::string notice(const std::filesystem::path& newest) const;

private:
  EditedScene(const RunFolder& folder, std::string text, const Scene& scene)
      : folder_(folder), file_(folder.scene()), text_(std::move(text)), scene_(scene) {}

  RunFolder folder_;
  std::filesystem::path file_; // where the edited text is
  std::string text_;
  const Scene& scene_;
};

} // namespace keeler
