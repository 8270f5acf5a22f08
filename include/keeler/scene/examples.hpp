// The scenes of examples/, embedded at build so that the program has them anywhere: to be run by their names, and to
// begin one's own from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace keeler {

struct ExampleScene {
  /// A table that belongs to a scene, for `keeler generate --from-table`.
  struct Table {
    std::string_view file, text;
  };
  std::string_view name, toml;
  std::vector<Table> tables;

  /// Its first line, a comment that says what it shows.
  std::string_view about() const;
};

/// In the order of their names.
const std::vector<ExampleScene>& example_scenes();

/// Throws UsageError with the nearest name when there is none of this one.
const ExampleScene& find_example(const std::string& name);

/// The text of the scene file at this path, or else of the example of this name. Throws UsageError when there is
/// neither.
std::string read_scene_text(const std::string& path);

} // namespace keeler
