#include "suggest.hpp"

#include <keeler/core/suggest.hpp>
#include <keeler/scene/keys.hpp>

#include <vector>

namespace keeler {

std::string suggest_path(const std::string& path) {
  const Key asked{.path = declared_path(path)};
  std::vector<std::string> siblings, all;
  for (const Section& section : scene_sections())
    all.push_back(section.path);
  for (const Key& key : scene_keys())
    all.push_back(key.path);
  for (const std::string& known : all)
    if (Key{.path = known}.section() == asked.section())
      siblings.push_back(Key{.path = known}.name());

  if (const std::string near = closest(asked.name(), siblings); !near.empty())
    return near;
  for (const std::string& known : all)
    if (Key{.path = known}.name() == asked.name())
      return known;
  return closest(path, all);
}

} // namespace keeler
