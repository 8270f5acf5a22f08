#include "presets.hpp"

#include <keeler/config/document.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::scene {

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const PresetText& preset : preset_texts())
    names.emplace_back(preset.name);
  return names;
}

PlanetSettings find_preset(const std::string& name) {
  const auto& presets = preset_texts();
  const auto preset = std::find_if(presets.begin(), presets.end(), [&](const PresetText& p) { return p.name == name; });
  assert(preset != presets.end());
  const config::Schema no_schema; // the file has three numbers at its top level
  const config::TomlDocument document = parse_document(std::string(preset->toml), "preset " + name, no_schema);
  const auto number = [&](const char* key) { return std::get<double>(find_entry(document, key)->value); };
  return {name, number("orbital_frequency"), {number("epicyclic_ratio"), number("vertical_ratio")}};
}

} // namespace keeler::scene
