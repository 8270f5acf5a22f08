// Readers of scenes for commands: with overrides of a file, for a table of particles, and with the choice that a start
// decides.
#pragma once

#include <keeler/config/overrides.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::scene {

/// As load_scene(), with overrides that another file gives; a later one acts on top of an earlier one.
Scene load_varied_scene(const std::string& path, const std::vector<config::Override>& overrides);

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

/// True if the scene leaves gravity.resting_contacts to its start: its resolved text says "auto".
bool leaves_resting_open(const Scene& scene);

/// Returns the scene with the choice that its start decides (resting_choice.hpp), also in its resolved text. A scene
/// that leaves nothing open is returned unchanged.
Scene decided_by(const Scene& scene, const PatchScale& start);

} // namespace keeler::scene
