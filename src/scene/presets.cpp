#include "presets.hpp"

#include "document.hpp"

#include <cassert>

namespace keeler {

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const PresetText& preset : preset_texts())
    names.emplace_back(preset.name);
  return names;
}

PlanetSettings find_preset(const std::string& name) {
  for (const PresetText& preset : preset_texts())
    if (preset.name == name) {
      const Document document = parse_document(std::string(preset.toml), "preset " + name);
      const auto number = [&](const char* key) { return std::get<double>(find_entry(document, key)->value); };
      return {name, number("orbital_frequency"), {number("epicyclic_ratio"), number("vertical_ratio")}};
    }
  assert(!"the key table offers only presets that exist");
  return {};
}

} // namespace keeler
