// keeler new: copies a shipped example as the beginning of a user's scene.
#include "command.hpp"
#include "common_options.hpp"
#include "print.hpp"
#include "results.hpp"

#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/scene/examples.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string name;
  std::optional<std::string> output;
  bool list = false, force = false;
};

ExitCode list_examples() {
  for (const scene::ExampleScene& example : scene::example_scenes())
    print("{:<20} {}\n", example.name, example.about());
  return ExitCode::done;
}

// Writes the scene and its tables into one folder. Writes nothing if one of the files exists.
ExitCode write_example(const NewOptions& options) {
  const scene::ExampleScene& example = scene::find_example(options.name);
  const fs::path scene = options.output ? output_named(*options.output) : fs::path(options.name + ".toml");
  if (files::is_stream(scene) && !example.tables.empty())
    throw UsageError(fmt::format("'{}' cannot take the example {} (it needs tables in further files); name a file",
                                 scene.string(), options.name));
  require_new_file(scene, options.force, "a scene");
  for (const scene::ExampleScene::Table& table : example.tables)
    require_new_file(scene.parent_path() / table.file, options.force, "a table");
  files::write_text(scene, example.toml);
  print_written(scene);
  for (const scene::ExampleScene::Table& table : example.tables) {
    const fs::path file = scene.parent_path() / table.file;
    files::write_text(file, table.text);
    print_written(file);
  }
  return ExitCode::done;
}

ExitCode make_new(const NewOptions& options) {
  if (options.list || options.name.empty())
    return list_examples();
  return write_example(options);
}

} // namespace

void add_new(CLI::App& program, Action& action) {
  const auto options = std::make_shared<NewOptions>();
  CLI::App& command =
      *program.add_subcommand("new", "write one of the shipped examples as a scene of your own, with comments");
  CLI::Option* const name = command.add_option("NAME", options->name, "the example")->type_name("");
  CLI::Option* const output =
      command.add_option("-o,--output", options->output, "the scene to write (default: NAME.toml)")->type_name("FILE");
  command.add_flag("--list", options->list, "list the examples, as without NAME")->excludes(name)->excludes(output);
  command.add_flag("--force", options->force, "replace files that exist");
  examples_of(command, {"keeler new --list", "keeler new moonlet", "keeler new a-ring-wakes -o mine.toml"});
  command.callback([options, &action] { action = [options] { return make_new(*options); }; });
}

} // namespace keeler::cli
