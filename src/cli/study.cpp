// keeler study: experiments with tables, figures and a report.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/study/finders/study.hpp>
#include <keeler/study/scene/study.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace keeler::cli {
namespace {

using Words = std::vector<std::string>;

template<class Settings> struct StudyOptions {
  Settings settings;
  TalkOption talk;
  SceneArguments scene; // unused by a study without a scene

  void add_to(CLI::App& command) {
    command.add_option("-o,--output", settings.folder, "the folder for the results; a study in it is continued")
        ->required()
        ->type_name("DIR");
    talk.add_to(command);
  }

  // Returns what `study` returns, and shows its progress.
  template<class Study> auto carry_out(const Study& study) {
    talk.say_program();
    require_folder_name(settings.folder);
    ProgressLine line(talk);
    settings.notice = [&](const std::string& text) { line.note(text); };
    settings.progress = [&](const Progress& progress) { line.show(progress); };
    return using_json_of<nlohmann::json>(settings.folder, study);
  }
};

ExitCode continues_later() {
  say("stopped; the same command continues from here");
  return ExitCode::stopped;
}

void print_results(const std::filesystem::path& folder, const std::vector<const char*>& names) {
  for (const char* const name : names)
    print("{}/{}\n", folder.string(), name);
}

// Makes the command the program's action, with the command line for the provenance of its results.
template<class Options>
void act(CLI::App& command, Action& action, const Words& arguments, const std::shared_ptr<Options>& options,
         ExitCode (*study)(Options&)) {
  command.callback([options, arguments, study, &action] {
    requests_from_signals(); // before signals are released
    options->settings.arguments = arguments;
    action = [options, study] { return study(*options); };
  });
}

ExitCode of_finders(StudyOptions<study::FinderStudySettings>& options) {
  bool finished = false;
  try {
    const Interruptible measurement(requests_from_signals().give_up); // a second signal interrupts a measurement
    finished = options.carry_out([&] { return study_finders(options.settings, requests_from_signals().stop); });
  } catch (const Interrupted&) { // the finished measurements are in the folder
  }
  if (!finished)
    return continues_later();
  print_results(options.settings.folder, {"report.md", "report.html", "finders.csv", "finders.json", "figures"});
  return ExitCode::done;
}

void add_finders(CLI::App& study, Action& action, const Words& arguments) {
  const auto options = std::make_shared<StudyOptions<study::FinderStudySettings>>();
  CLI::App& command = *study.add_subcommand(
      "finders", "the collision finders: times, errors and the paper's claims, on four states; after a stop (exit 75) "
                 "the same command continues");
  options->add_to(command);
  command.add_option("--count", options->settings.count, "particles of equal size (default: 10000, about 95 minutes)")
      ->transform(particle_number());
  command.add_flag("--quick", options->settings.quick, "3000 particles, three steps, two repeats: a few minutes");
  examples_of(command, {"keeler study finders -o finders"});
  act(command, action, arguments, options, of_finders);
}

ExitCode of_scene(StudyOptions<study::SceneStudySettings>& options) {
  study::SceneStudySettings& settings = options.settings;
  settings.scene = options.scene.path;
  settings.overrides = options.scene.overrides;
  if (settings.jobs == 0)
    settings.jobs = static_cast<std::size_t>(std::max(1, threads()));
  const batch::BatchResult result = options.carry_out([&] { return study_scene(settings, requests_from_signals()); });
  if (result.stopped)
    return continues_later();
  print_results(settings.folder, {"report.md", "report.html", "study.csv", "settings.csv", "figures"});
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

void add_of_scene(CLI::App& study, Action& action, const Words& arguments, study::SceneStudyKind kind,
                  const std::string& name, const std::string& about) {
  const auto options = std::make_shared<StudyOptions<study::SceneStudySettings>>();
  study::SceneStudySettings& settings = options->settings;
  settings.kind = kind;
  settings.jobs = 0; // one per thread of the machine
  CLI::App& command =
      *study.add_subcommand(name, about + "; after a stop (exit 75) or kill the same command continues");
  options->scene.add_to(command)->required();
  options->add_to(command);
  command.add_option("--seeds", settings.seeds, "runs per setting (default: 3)")
      ->transform(whole_number_between(1, max_seeds, "a number of seeds"));
  command
      .add_option("--grow", settings.grow_orbits,
                  "orbits before the comparison begins (default: 6 with self-gravity, 10 without)")
      ->check(positive_number(max_orbits));
  command.add_option("--orbits", settings.orbits, "orbits of each run after that (default: 6)")
      ->check(positive_number(max_orbits));
  command.add_option("--jobs", settings.jobs, "concurrent runs, each on one thread (default: threads of the machine)")
      ->transform(whole_number_between(1, max_threads, "a number of runs"));
  add_quantities(command, settings.quantities);
  command.add_flag("--quick", settings.quick,
                   "few settings, and by default two seeds, one orbit before the comparison and two after it");
  examples_of(command, {"keeler study " + name + " scene.toml -o " + name});
  act(command, action, arguments, options, of_scene);
}

// Names what has replaced a study of earlier versions.
void refuse_gravity(CLI::App& study) {
  CLI::App& command = *study.add_subcommand("gravity", "")->group("")->prefix_command();
  command.set_help_flag();
  command.callback([] {
    throw UsageError("there is no 'keeler study gravity' any more; \"keeler study mesh a-ring-wakes -o DIR\" compares "
                     "the solvers, \"keeler bench gravity\" has the errors and costs of more settings");
  });
}

} // namespace

void add_study(CLI::App& program, Action& action, const Words& arguments) {
  CLI::App& command = *program.add_subcommand("study", "carry out an experiment and write a report on it");
  command.require_subcommand(1);
  add_finders(command, action, arguments);
  const auto add = [&](study::SceneStudyKind kind, const std::string& name, const std::string& about) {
    add_of_scene(command, action, arguments, kind, name, about);
  };
  add(study::SceneStudyKind::step, "step", "your scene with several step lengths: cost and effect");
  add(study::SceneStudyKind::kicks, "kicks", "your scene with several kick intervals of self-gravity");
  add(study::SceneStudyKind::mesh, "mesh", "your scene with several solvers and accuracies of self-gravity");
  add(study::SceneStudyKind::box, "box", "your scene in boxes of several sizes");
  add(study::SceneStudyKind::sizes, "sizes", "your scene without the smallest particles of its distribution");
  refuse_gravity(command);
}

} // namespace keeler::cli
