// Reads and checks scenes: from a file, an example or a text, with overrides on top.
#pragma once

#include <keeler/config/overrides.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// Reads and checks a scene file. Overrides are "a.b=value" with TOML values (bare words are strings). `from` replaces
/// start.from; messages call it --from. Throws UsageError "file:line:column: problem; what to do" for the first fault.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides = {},
                 const std::optional<std::string>& from = {});

/// As load_scene(), with overrides that another file gives; a later one acts on top of an earlier one.
Scene load_varied_scene(const std::string& path, const std::vector<Override>& overrides);

/// As load_scene(), from a text; messages call it `name`.
Scene parse_scene(const std::string& text, const std::string& name, const std::vector<std::string>& overrides = {},
                  const std::optional<std::string>& from = {});

/// A scene for a table of particles. Its keys of particles are ignored and may be absent, except for the density.
struct TableScene {
  Scene scene;                   ///< its particles are placeholders
  std::optional<double> density; ///< kg/m³, if the scene has it
};

/// As load_scene(). Throws UsageError also if the scene lacks box.size or has start.from.
TableScene load_table_scene(const std::string& path, const std::vector<std::string>& overrides);
/// As load_table_scene(), from a text; messages call it `name`.
TableScene parse_table_scene(const std::string& text, const std::string& name,
                             const std::vector<std::string>& overrides = {});

/// Parses the scene of a snapshot or checkpoint, to continue from it. Keys that only the start needs (box, sizes) are
/// checked for their ranges but not read, so that a file of radii or a start file may be absent.
Scene parse_stored_scene(const std::string& text, const std::string& name);
/// As parse_stored_scene(), for the scene.toml of a run. Throws IoError if it cannot be read or is not a valid scene.
Scene load_stored_scene(const std::filesystem::path& file);

/// True if the scene leaves gravity.resting_contacts to its start: its resolved text says "auto".
bool leaves_resting_open(const Scene& scene);

/// Returns the scene with the choice that its start decides (resting_choice.hpp), also in its resolved text. A scene
/// that leaves nothing open is returned unchanged.
Scene decided_by(const Scene& scene, const PatchScale& start);

} // namespace keeler
