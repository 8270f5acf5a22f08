#include "start_source.hpp"

#include <keeler/config/overrides.hpp>
#include <keeler/scene/keys.hpp>

namespace keeler::scene {

void apply_start(config::TomlDocument& document, const std::string& snapshot, std::vector<std::string>& notices) {
  apply_text(document, "start.from", snapshot, "--from " + snapshot, notices);
}

void apply_table(config::TomlDocument& document) {
  if (const config::DocumentEntry* entry = find_entry(document, "start.from"))
    config::fail_at(entry->value_location,
                    "start.from cannot be combined with a table of particles (either is the start); remove one "
                    "of the two");
  if (const config::DocumentEntry* entry = find_entry(document, "box.size_in_wavelengths"))
    config::fail_at(entry->value_location,
                    "box.size_in_wavelengths cannot be combined with a table of particles (the wavelength "
                    "follows from a surface density that the scene asks for); give box.size");
  document.remove_if([](const config::DocumentEntry& entry) {
    return entry.path.starts_with("particles.") && entry.path != "particles.density" &&
           (find_key(entry.path) || find_section(entry.path));
  });
  std::vector<std::string> none;
  const auto set = [&](const char* key, const char* value) { apply_override(document, {key, value, key, key}, none); };
  set("particles.count", "1");
  set("particles.sizes", "{ law = \"equal\", radius = 1e-6 }");
  if (!find_entry(document, "particles.density"))
    set("particles.density", "1000.0");
}

} // namespace keeler::scene
