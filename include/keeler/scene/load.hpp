// Reads and checks scenes: from a file, an example or a text, with overrides on top.
#pragma once

#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler::scene {

/// Reads and checks a scene file. Overrides are "a.b=value" with TOML values (bare words are strings). `from` replaces
/// start.from; messages call it --from. Throws UsageError "file:line:column: problem; what to do" for the first fault.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides = {},
                 const std::optional<std::string>& from = {});

/// As load_scene(), from a text; messages call it `name`.
Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides = {},
                  const std::optional<std::string>& from = {});

/// Parses the scene of a snapshot or checkpoint, to continue from it. Keys that only the start needs (box, sizes) are
/// checked for their ranges but not read, so that a file of radii or a start file may be absent.
Scene parse_stored_scene(const std::string& text, const std::string& name);
/// As parse_stored_scene(), for the scene.toml of a run. Throws IoError if it cannot be read or is not a valid scene.
Scene load_stored_scene(const std::filesystem::path& file);

} // namespace keeler::scene

namespace keeler {
using scene::load_scene, scene::parse_scene;
} // namespace keeler
