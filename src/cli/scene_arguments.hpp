// The arguments of commands that read a scene: the file and its overrides.
#pragma once

#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::cli {

struct SceneArguments {
  std::string path;
  std::vector<std::string> overrides;

  /// Adds SCENE and --set to a command. Returns SCENE, so that the caller can make it required.
  CLI::Option* add_to(CLI::App& command, const std::string& name = "SCENE",
                      const std::string& about = "scene file (TOML), or the name of an example");

  /// Reads the scene. `from` is the snapshot of --from.
  Scene load(const std::optional<std::string>& from = {}) const { return load_scene(path, overrides, from); }
};

} // namespace keeler::cli
