// keeler study: experiments with tables, figures and a report.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "study_scene.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/study/finders/study.hpp>
#include <keeler/study/gravity/study.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace keeler {
namespace {

// Carries out a study and prints the names of its results.
template<class Settings, class Study>
ExitCode carry_out(Settings& settings, const TalkOption& talk, const Study& study,
                   const std::vector<const char*>& results) {
  talk.say_program();
  require_folder_name(settings.folder);
  bool finished = false;
  {
    ProgressLine line(talk);
    settings.notice = [&](const std::string& text) { line.note(text); };
    settings.progress = [&](const Progress& progress) { line.show(progress); };
    try {
      const Interruptible measurement(requests_from_signals().give_up); // a second signal interrupts a measurement
      finished =
          using_json_of<nlohmann::json>(settings.folder, [&] { return study(settings, requests_from_signals().stop); });
    } catch (const Interrupted&) { // the finished measurements are in the folder
    }
  }
  if (!finished) {
    say("stopped; the same command continues from here");
    return ExitCode::stopped;
  }
  for (const char* name : results)
    print("{}/{}\n", settings.folder.string(), name);
  return ExitCode::done;
}

template<class Settings> void add_folder(CLI::App& command, Settings& settings) {
  command.add_option("-o,--output", settings.folder, "the folder for the results; a study in it is continued")
      ->required()
      ->type_name("DIR");
}

void add_finders(CLI::App& command, Action& action, const std::vector<std::string>& arguments) {
  const auto settings = std::make_shared<FinderStudySettings>();
  CLI::App& finders = *command.add_subcommand(
      "finders", "the collision finders: times, errors and the paper's claims, on four states; after a stop (exit 75) "
                 "the same command continues");
  add_folder(finders, *settings);
  const auto talk = std::make_shared<TalkOption>();
  talk->add_to(finders);
  finders.add_option("--count", settings->count, "particles of equal size (default: 10000, about 95 minutes)")
      ->transform(particle_number());
  finders.add_flag("--quick", settings->quick, "3000 particles, three steps, two repeats: a few minutes");
  examples_of(finders, {"keeler study finders -o finders"});
  finders.callback([settings, talk, arguments, &action] {
    requests_from_signals(); // before signals are released
    settings->arguments = arguments;
    action = [settings, talk] {
      return carry_out(*settings, *talk, study_finders,
                       {"report.md", "report.html", "finders.csv", "finders.json", "figures"});
    };
  });
}

// Sets the options that the command line does not give to small values.
void make_quick(GravityStudySettings& settings, const CLI::App& command) {
  const auto is_default = [&](const char* option) { return command.count(option) == 0; };
  if (is_default("--count"))
    settings.count = 5000;
  if (is_default("--repeats"))
    settings.repeats = 2;
  if (is_default("--orbits"))
    settings.orbits = 0.5;
  if (is_default("--seeds"))
    settings.seeds = 2;
}

void add_gravity(CLI::App& command, Action& action, const std::vector<std::string>& arguments) {
  const auto settings = std::make_shared<GravityStudySettings>();
  CLI::App& gravity = *command.add_subcommand(
      "gravity", "the gravity solvers: error against cost, and whether the physics of wakes depends on them or on the "
                 "kick interval; after a stop (exit 75) the same command continues");
  add_folder(gravity, *settings);
  const auto talk = std::make_shared<TalkOption>();
  talk->add_to(gravity);
  gravity.add_option("--count", settings->count, "particles of the state (default: 100000)")
      ->transform(particle_number());
  gravity.add_option("--repeats", settings->repeats, "number of measurements; their medians are printed (default: 5)")
      ->transform(repeat_number());
  gravity.add_option("--orbits", settings->orbits, "measured orbits of each run (default: 4)")
      ->check(positive_number(max_orbits));
  gravity.add_option("--seeds", settings->seeds, "runs per solver and kick interval (default: 3)")
      ->transform(whole_number_between(1, max_seeds, "a number of seeds"));
  const auto quick = std::make_shared<bool>(false);
  gravity.add_flag("--quick", *quick,
                   "by default 5000 particles, two repeats, two seeds and half an orbit: two or three minutes");
  examples_of(gravity, {"keeler study gravity -o gravity"});
  gravity.callback([settings, talk, quick, arguments, &gravity, &action] {
    requests_from_signals(); // before signals are released
    settings->arguments = arguments;
    if (*quick)
      make_quick(*settings, gravity);
    action = [settings, talk] {
      return carry_out(*settings, *talk, study_gravity,
                       {"report.md", "report.html", "gravity.csv", "gravity_runs.csv", "gravity.json", "figures"});
    };
  });
}

} // namespace

void add_study(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  CLI::App& command = *program.add_subcommand("study", "carry out an experiment and write a report on it");
  command.require_subcommand(1);
  add_finders(command, action, arguments);
  add_gravity(command, action, arguments);
  add_scene_studies(command, action, arguments);
}

} // namespace keeler
