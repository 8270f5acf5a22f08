// The scenes of examples/, embedded at build time: they run by their names, and are templates for scenes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace keeler::scene {

struct ExampleScene {
  /// A table that belongs to a scene, for `keeler generate --from-table`.
  struct Table {
    std::string_view file, text;
  };
  std::string_view name, toml;
  std::vector<Table> tables;

  /// Returns the text of its first line, a comment that says what the example shows.
  std::string_view about() const;
};

/// Returns all examples in the order of their names.
const std::vector<ExampleScene>& example_scenes();

/// Returns the example of this name. Throws UsageError with the nearest name if there is none.
const ExampleScene& find_example(const std::string& name);

/// Returns the text of the scene file at this path, or else of the example of this name. Throws UsageError if there is
/// neither.
std::string read_scene_text(const std::string& path);

} // namespace keeler::scene
