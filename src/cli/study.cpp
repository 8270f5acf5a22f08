// keeler study: whole experiments, with tables, figures and a report.
#include "command.hpp"
#include "common_options.hpp"
#include "progress_line.hpp"
#include "signals.hpp"

#include <keeler/study/finder_study.hpp>

#include <fmt/format.h>

#include <memory>

namespace keeler {
namespace {

ExitCode study(FinderStudySettings& settings) {
  bool finished = false;
  {
    ProgressLine line;
    settings.notice = [&](const std::string& text) { line.note(text); };
    settings.progress = [&](const StudyProgress& progress) { line.show(progress); };
    finished = study_finders(settings, requests_from_signals().stop);
  }
  const std::string folder = settings.folder.string();
  if (!finished) {
    fmt::print(stderr, "keeler: stopped; the same command goes on from here\n");
    return ExitCode::stopped;
  }
  for (const char* name : {"report.md", "report.html", "finders.csv", "finders.json", "figures"})
    fmt::print("{}/{}\n", folder, name);
  return ExitCode::done;
}

} // namespace

void add_study(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  const auto settings = std::make_shared<FinderStudySettings>();
  CLI::App& command = *program.add_subcommand("study", "carry out an experiment and write a report on it");
  command.require_subcommand(1);
  CLI::App& finders = *command.add_subcommand(
      "finders", "the collision finders: time, truth and the paper's claims, on four states; stopped (exit 75), the "
                 "same command goes on");
  finders.add_option("-o,--output", settings->folder, "the folder for the results; a study in it is continued")
      ->required();
  finders.add_option("--count", settings->count, "particles of equal size (default: 10000, some 95 minutes)")
      ->check(positive_number());
  finders.add_flag("--quick", settings->quick, "3000 particles, three steps, two repeats: a few minutes");
  finders.callback([settings, arguments, &action] {
    settings->arguments = arguments;
    action = [settings] { return study(*settings); };
  });
}

} // namespace keeler
