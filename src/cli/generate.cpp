// keeler generate: an initial state, as a snapshot in double precision.
#include "command.hpp"
#include "common_options.hpp"
#include "scene_arguments.hpp"

#include <keeler/io/snapshot.hpp>
#include <keeler/states/initial.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace keeler {
namespace {

struct GenerateOptions {
  SceneArguments scene;
  std::string output;
  bool force = false;
  ThreadOption threads;
};

ExitCode generate(const GenerateOptions& options, const std::vector<std::string>& arguments) {
  options.threads.apply();
  const Scene scene = options.scene.load();
  if (std::filesystem::is_directory(options.output))
    throw UsageError(fmt::format("'{}' is a folder (a state is one file); name a file in it", options.output));
  if (std::filesystem::exists(options.output) && !options.force)
    throw UsageError(fmt::format("'{}' exists already (a state is never overwritten); name another file or add --force",
                                 options.output));
  const Patch patch = initial_patch(scene);
  write_snapshot(options.output, patch, {scene.resolved, collect_provenance(arguments)});
  fmt::print("{} particles in {:.5g} m x {:.5g} m, no overlaps: {}\n", patch.size(), patch.box.size_x, patch.box.size_y,
             options.output);
  return ExitCode::done;
}

} // namespace

void add_generate(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  const auto options = std::make_shared<GenerateOptions>();
  CLI::App& command = *program.add_subcommand("generate", "write the initial state of a scene as a snapshot");
  options->scene.add_to(command)->required();
  command.add_option("-o,--output", options->output, "the snapshot to write; give it the ending .hdf")->required();
  command.add_flag("--force", options->force, "replace the file if it exists");
  options->threads.add_to(command);
  command.callback(
      [options, arguments, &action] { action = [options, arguments] { return generate(*options, arguments); }; });
}

} // namespace keeler
