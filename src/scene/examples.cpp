#include <keeler/scene/examples.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/suggest.hpp>
#include <keeler/files/input.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace keeler::scene {
namespace {

const ExampleScene* example_named(const std::string& name) {
  const std::vector<ExampleScene>& all = example_scenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ExampleScene& e) { return e.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string nearest_example(const std::string& name) {
  std::vector<std::string> names;
  for (const ExampleScene& example : example_scenes())
    names.emplace_back(example.name);
  return closest(name, names);
}

// True if the path has neither folder nor ending: examples are named so.
bool could_be_example(const std::string& path) {
  return path.find_first_of("/.") == std::string::npos;
}

} // namespace

std::string_view ExampleScene::about() const {
  const std::string_view line = toml.substr(0, toml.find('\n'));
  return line.substr(std::min(line.size(), line.find_first_not_of("# ")));
}

const ExampleScene& find_example(const std::string& name) {
  if (const ExampleScene* example = example_named(name))
    return *example;
  const std::string near = nearest_example(name);
  throw UsageError(
      fmt::format("there is no example '{}'; {}", name,
                  near.empty() ? "\"keeler new --list\" lists them" : fmt::format("did you mean '{}'?", near)));
}

std::string read_scene_text(const std::string& path) {
  std::error_code unknown;
  const ExampleScene* const example = could_be_example(path) ? example_named(path) : nullptr;
  const bool exists = std::filesystem::exists(path, unknown);
  if (example &&
      (!exists || std::filesystem::is_directory(path, unknown))) // folders of runs often have their example's name
    return std::string(example->toml);
  if (!could_be_example(path) || exists)
    return files::read_input(path, path);
  const std::string near = nearest_example(path);
  throw UsageError(fmt::format("{}: there is no file and no example of this name; {}", path,
                               near.empty() ? "check the path, or see \"keeler new --list\""
                                            : fmt::format("did you mean '{}'?", near)));
}

} // namespace keeler::scene
