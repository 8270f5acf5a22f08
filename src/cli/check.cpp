// keeler check: validates a scene and prints its derived quantities, warnings and cost.
#include "check_numbers.hpp"
#include "command.hpp"
#include "print_record.hpp"
#include "scene_arguments.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/advice/estimate.hpp>
#include <keeler/advice/warnings.hpp>
#include <keeler/bench/yardsticks.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keeler::cli {
namespace {

struct CheckOptions {
  SceneArguments scene;
  bool json = false;
  bool defaults = false;
  bool markdown = false;
};

using Lines = std::vector<std::string>;

// Returns size and density of the patch, from the start file if the scene has one.
scene::PatchScale scale_of_start(const Scene& scene) {
  return scene.start_from || scene.particles.start ? initial_conditions::scale_of(initial_patch(scene))
                                                   : scale_of(scene);
}

// Returns the estimated cost of the run; none if the particles come from a start file.
std::optional<advice::RunEstimate> estimate(const Scene& scene, const advice::Derived& d) {
  if (!d.particles_known)
    return std::nullopt;
  set_threads(1);
  return advice::estimate_run(scene, bench::pair_yardstick(cpu_seconds));
}

ExitCode check(const CheckOptions& options) {
  if (options.defaults) {
    print("{}", scene::describe_keys(options.markdown));
    return ExitCode::done;
  }
  if (options.scene.path.empty())
    throw UsageError("check needs a scene (there is nothing to check); write keeler check SCENE, or --defaults");
  const Scene asked = options.scene.load();
  initial_conditions::require_start_file(asked);
  const scene::PatchScale start = scale_of_start(asked);
  const Scene scene = decided_by(asked, start);
  Lines notes = advice::warnings(scene, start);
  const advice::Derived derived = advice::derive(scene);
  if (const double left = 1e-6 * available_memory(); derived.memory_mb > left)
    notes.push_back(fmt::format("the run needs about {} GB of memory, and {} GB are available: \"keeler run\" refuses "
                                "it; use fewer particles, a coarser mesh, or a machine with more memory",
                                format_number(1e-3 * derived.memory_mb, 3), format_number(1e-3 * left, 3)));
  print_record(record_of(CheckedScene{scene, start, derived, estimate(scene, derived), notes}), options.json);
  return ExitCode::done;
}

} // namespace

void add_check(CLI::App& program, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App& command =
      *program.add_subcommand("check", "validate a scene and print its derived quantities; runs nothing");
  options->scene.add_to(command);
  command.add_flag("--json", options->json, "print the numbers as JSON");
  CLI::Option* defaults =
      command.add_flag("--defaults", options->defaults, "print every key with its default, unit and meaning");
  command.add_flag("--markdown", options->markdown, "print the keys as the manual's table")->needs(defaults);
  examples_of(command, {"keeler check scene.toml", "keeler check scene.toml --set particles.optical_depth=0.8",
                        "keeler check --defaults"});
  command.callback([options, &action] { action = [options] { return check(*options); }; });
}

} // namespace keeler::cli
