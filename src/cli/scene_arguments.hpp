// The arguments of every command that takes a scene: the file and its overrides.
#pragma once

#include <keeler/scene/scene.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace keeler {

struct SceneArguments {
  std::string path;
  std::vector<std::string> overrides;

  /// Adds SCENE and --set to a command; returns SCENE, so that the command can make it required.
  CLI::Option* add_to(CLI::App& command);

  Scene load() const { return load_scene(path, overrides); }
};

} // namespace keeler
