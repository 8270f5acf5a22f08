#include "suggest.hpp"

#include <keeler/core/suggest.hpp>

#include <vector>

namespace keeler::config {

std::string suggest_path(const std::string& path, const Schema& schema) {
  const Key asked{.path = declared_path(path)};
  std::vector<std::string> siblings, all;
  for (const Section& section : schema.sections())
    all.push_back(section.path);
  for (const Key& key : schema.keys())
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

} // namespace keeler::config
