// Locations in rings with known frequencies: the files of data/presets, embedded at build time.
#pragma once

#include <keeler/scene/planet.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace keeler::scene {

struct PresetText {
  std::string_view name;
  std::string_view toml;
};

/// Returns all presets; the build generates it from data/presets.
const std::vector<PresetText>& preset_texts();

std::vector<std::string> preset_names();

/// Returns the frequencies of a preset. Precondition: `name` is one of preset_names().
PlanetSettings find_preset(const std::string& name);

} // namespace keeler::scene
