// Places with known frequencies: the files of data/presets, embedded at build so that the program runs from anywhere.
#pragma once

#include <keeler/scene/scene.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace keeler {

struct PresetText {
  std::string_view name;
  std::string_view toml;
};

/// Generated from data/presets by the build.
const std::vector<PresetText>& preset_texts();

std::vector<std::string> preset_names();

/// The frequencies of a preset; the name is one of preset_names().
PlanetSettings find_preset(const std::string& name);

} // namespace keeler
