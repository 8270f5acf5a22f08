// A scene.toml that was edited after a run wrote it. A resumed run continues with the scene of its checkpoint and
// writes scene.toml again. The edited text is kept under another name, and the user is told the command that would use
// it.
#pragma once

#include "run_folder.hpp"

#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace keeler::runs {

class EditedScene {
public:
  /// Returns none if scene.toml is missing or unchanged: equal to `stored`, the text in the checkpoint, or to its
  /// resolved form by this program. `scene` must outlive the result. Throws IoError.
  static std::optional<EditedScene> in(const RunFolder& folder, const std::string& stored, const Scene& scene);

  /// Renames scene.toml to the first free name of scene_edited.toml, scene_edited_2.toml …, before the run continues.
  /// Throws IoError.
  void keep_apart();

  /// Returns a line with the ignored changes, the file that has them and the command that uses it. `newest` is the
  /// newest snapshot.
  std::string notice(const std::filesystem::path& newest) const;

private:
  EditedScene(const RunFolder& folder, std::string text, const Scene& scene)
      : folder_(folder), file_(folder.scene()), text_(std::move(text)), scene_(scene) {}

  RunFolder folder_;
  std::filesystem::path file_; // where the edited text is
  std::string text_;
  const Scene& scene_;
};

} // namespace keeler::runs
