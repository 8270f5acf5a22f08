#include "study_scene.hpp"

#include "common_options.hpp"
#include "messages.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/study/scene/study.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace keeler {
namespace {

struct SceneStudyOptions {
  SceneArguments scene;
  SceneStudySettings settings;
  std::size_t jobs = 0; // 0: one per thread of the machine
  TalkOption talk;
};

ExitCode carry_out(SceneStudyOptions& options) {
  options.talk.say_program();
  SceneStudySettings& settings = options.settings;
  require_folder_name(settings.folder);
  settings.scene = options.scene.path;
  settings.overrides = options.scene.overrides;
  settings.jobs = options.jobs > 0 ? options.jobs : static_cast<std::size_t>(std::max(1, threads()));
  SceneStudyResult result;
  {
    ProgressLine line(options.talk);
    settings.notice = [&](const std::string& text) { line.note(text); };
    settings.progress = [&](const Progress& progress) { line.show(progress); };
    result =
        using_json_of<nlohmann::json>(settings.folder, [&] { return study_scene(settings, requests_from_signals()); });
  }
  if (result.stopped) {
    say("stopped; the same command continues from here");
    return ExitCode::stopped;
  }
  for (const char* const name : {"report.md", "report.html", "study.csv", "settings.csv", "figures"})
    print("{}/{}\n", settings.folder.string(), name);
  const auto say_missing = [](std::size_t count, const std::string& advice) {
    if (count > 0)
      say(fmt::format("{} missing, the report has the reasons; {}",
                      count == 1 ? "a run is" : fmt::format("{} runs are", count), advice));
  };
  say_missing(result.failed - result.unmeasurable, "the same command tries again");
  say_missing(result.unmeasurable,
              fmt::format("remove the damaged files from '{}', and the same command makes them again",
                          (settings.folder / "runs").string()));
  return result.failed > 0 ? ExitCode::run_time : ExitCode::done;
}

void add_one(CLI::App& study, Action& action, const std::vector<std::string>& arguments, SceneStudyKind kind,
             const std::string& name, const std::string& about) {
  const auto options = std::make_shared<SceneStudyOptions>();
  SceneStudySettings& settings = options->settings;
  settings.kind = kind;
  CLI::App& command =
      *study.add_subcommand(name, about + "; after a stop (exit 75) or kill the same command continues");
  options->scene.add_to(command)->required();
  command.add_option("-o,--output", settings.folder, "the folder for the results; a study in it is continued")
      ->required()
      ->type_name("DIR");
  options->talk.add_to(command);
  command.add_option("--seeds", settings.seeds, "runs per setting (default: 3)")
      ->transform(whole_number_between(1, max_seeds, "a number of seeds"));
  command
      .add_option("--grow", settings.grow_orbits,
                  "orbits before the comparison begins (default: 6 with self-gravity, 10 without)")
      ->check(positive_number(max_orbits));
  command.add_option("--orbits", settings.orbits, "orbits of each run after that (default: 6)")
      ->check(positive_number(max_orbits));
  command.add_option("--jobs", options->jobs, "concurrent runs, each on one thread (default: threads of the machine)")
      ->transform(whole_number_between(1, max_threads, "a number of runs"));
  add_quantities(command, settings.quantities);
  command.add_flag("--quick", settings.quick,
                   "few settings, and by default two seeds, one orbit before the comparison and two after it");
  examples_of(command, {"keeler study " + name + " scene.toml -o " + name});
  command.callback([options, arguments, &action] {
    requests_from_signals(); // before signals are released
    options->settings.arguments = arguments;
    action = [options] { return carry_out(*options); };
  });
}

} // namespace

void add_scene_studies(CLI::App& study, Action& action, const std::vector<std::string>& arguments) {
  add_one(study, action, arguments, SceneStudyKind::step, "step",
          "your scene with several step lengths: cost and effect");
  add_one(study, action, arguments, SceneStudyKind::kicks, "kicks",
          "your scene with several kick intervals of self-gravity");
  add_one(study, action, arguments, SceneStudyKind::mesh, "mesh",
          "your scene with several accuracies of self-gravity, by mesh and by tree");
  add_one(study, action, arguments, SceneStudyKind::box, "box", "your scene in boxes of several sizes");
  add_one(study, action, arguments, SceneStudyKind::sizes, "sizes",
          "your scene without the smallest particles of its distribution");
}

} // namespace keeler
