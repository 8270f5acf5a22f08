// keeler generate: an initial state, as a snapshot in double precision.
#include "command.hpp"
#include "common_options.hpp"
#include "progress_line.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <keeler/diagnostics/surface.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/states/clumped.hpp>
#include <keeler/states/initial.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include <unistd.h>

namespace keeler {
namespace {

struct GenerateOptions {
  SceneArguments scene;
  std::string output;
  bool clumped = false, force = false;
  ThreadOption threads;
};

void refuse_if_taken(const GenerateOptions& options) {
  if (std::filesystem::is_directory(options.output))
    throw UsageError(fmt::format("'{}' is a folder (a state is one file); name a file in it", options.output));
  if (std::filesystem::exists(options.output) && !options.force)
    throw UsageError(fmt::format("'{}' exists already (a state is never overwritten); name another file or add --force",
                                 options.output));
}

// Before minutes are spent on a state that cannot be written.
void require_folder(const std::string& output) {
  const std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
  if (!std::filesystem::is_directory(folder) || access(folder.c_str(), W_OK) != 0)
    throw IoError(fmt::format("cannot write '{}': '{}' is no folder that can be written to; make it, or name another",
                              output, folder.string()));
}

Patch make_patch(const Scene& scene) {
  std::optional<Patch> patch;
  {
    ProgressLine line;
    patch = initial_patch(
        scene, [&line](const StartProgress& progress) { line.show(progress); }, requests_from_signals().stop);
  }
  if (!patch)
    throw Error(ExitCode::run_time, "stopped before the start was made (on request), so no state is written");
  return std::move(*patch);
}

ClumpedState evolve_until_clumped(const Scene& scene) {
  std::optional<ClumpedState> state;
  {
    ProgressLine line;
    state = clumped_state(
        scene, [&line](const ClumpingProgress& progress) { line.show(progress); }, requests_from_signals().stop);
  }
  if (!state)
    throw Error(ExitCode::run_time, "stopped before the wakes had settled (on request), so no state is written; "
                                    "start again, or use \"keeler run\", which keeps checkpoints");
  return std::move(*state);
}

void print_clumping(const Clumping& c) {
  const Settling& s = c.settling;
  fmt::print(
      "settled after {:.4g} orbits: mean autocorrelation amplitude {:.3g} over the last orbit, {:.3g} over the one "
      "before\n",
      c.orbits, s.amplitude, s.before);
  fmt::print(
      "criterion: the mean changes by {:.1f} % (at most {:g} %), the state is {:.1f} % off it (at most {:g} %)\n",
      100.0 * s.change, 100.0 * c.criterion.largest_change, 100.0 * s.deviation, 100.0 * c.criterion.largest_deviation);
}

void print_doubts(const Patch& patch) {
  constexpr double enough = 4.0; // λ_cr: docs/dev/diagnostics.md
  const double wavelengths = std::min(patch.box.size_x, patch.box.size_y) / critical_wavelength(patch);
  if (wavelengths < 0.99 * enough)
    fmt::print("note: the box spans {:.2g} lambda_cr; below {:g} it holds so few wakes that their settling, pitch and "
               "spacing mean little\n",
               wavelengths, enough);
}

ExitCode generate(const GenerateOptions& options, const std::vector<std::string>& arguments) {
  options.threads.apply();
  const Scene scene = options.scene.load();
  refuse_if_taken(options);
  require_folder(options.output);
  SnapshotMeta meta{scene.resolved, collect_provenance(arguments)};
  Patch patch;
  if (options.clumped) {
    ClumpedState state = evolve_until_clumped(scene);
    patch = std::move(state.patch);
    meta.clumping = clumping_numbers(state.clumping);
    print_clumping(state.clumping);
    print_doubts(patch);
  } else {
    patch = make_patch(scene);
  }
  for (const std::string& notice : scene.notices)
    fmt::print(stderr, "keeler: {}\n", notice);
  write_snapshot(options.output, patch, meta);
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
  command.add_flag("--clumped", options->clumped,
                   "evolve the state under its own gravity until its wakes have settled");
  command.add_flag("--force", options->force, "replace the file if it exists");
  options->threads.add_to(command);
  command.callback(
      [options, arguments, &action] { action = [options, arguments] { return generate(*options, arguments); }; });
}

} // namespace keeler
