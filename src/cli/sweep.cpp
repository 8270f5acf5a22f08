// keeler sweep: many runs over a grid of keys and seeds.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "number_options.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "signals.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/sweep/sweep.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::cli {
namespace {

struct SweepOptions {
  sweep::SweepSettings settings;
  bool json = false;
  UnitsOption units;
  TalkOption talk;
};

void print_json(const sweep::SweepResult& result) {
  assert(result.points);
  const batch::Json json = {
      {"runs", result.runs}, {"finished", result.finished}, {"failed", result.failed}, {"points", *result.points}};
  print("{}\n", json_text(json, 2));
}

void print_text(const sweep::SweepResult& result, const std::filesystem::path& folder) {
  print("{}: {} finished, {} failed\n", pluralize(result.runs, "run"), result.finished, result.failed);
  for (const char* const name : {"sweep.csv", "points.csv", "report.md", "figure.svg"})
    if (std::filesystem::exists(folder / name))
      print("{}\n", (folder / name).string());
}

void say_failed(const sweep::SweepResult& result, const std::filesystem::path& folder) {
  if (!result.figure_fault.empty())
    say(result.figure_fault + "; the tables and report.md are written");
  if (result.failed > result.unmeasurable)
    say(fmt::format("{} failed, sweep.csv has the reasons; the same command tries again",
                    pluralize(result.failed - result.unmeasurable, "run")));
  if (result.unmeasurable > 0)
    say(fmt::format(
        "{} cannot be measured, sweep.csv has the reasons; remove the damaged files from '{}', and the same "
        "command makes them again",
        pluralize(result.unmeasurable, "finished run"), (folder / "runs").string()));
}

ExitCode carry_out(SweepOptions& options) {
  options.talk.say_program();
  sweep::SweepSettings& settings = options.settings;
  require_folder_name(settings.folder);
  settings.units = options.units.system();
  if (settings.jobs == 0)
    settings.jobs = static_cast<std::size_t>(std::max(1, threads() / settings.threads_per_run));
  sweep::SweepResult result;
  {
    ProgressLine line(options.talk);
    settings.progress = [&](const Progress& progress) { line.show(progress); };
    settings.notice = [&](const std::string& text) { line.note(text); };
    result = sweep::sweep(settings, requests_from_signals());
  }
  if (result.stopped) {
    say(result.began           ? "stopped, each run with a checkpoint; the same command continues from here"
        : settings.tables_only ? "stopped before the tables were made; the same command makes them"
                               : "stopped before any run was started; the same command begins again");
    return ExitCode::stopped;
  }
  if (options.json)
    print_json(result);
  else
    print_text(result, settings.folder);
  const std::size_t left = result.runs - result.finished - result.failed;
  if (left > 0)
    say(fmt::format("{} not finished; the tables have the others", pluralize(left, "run")));
  say_failed(result, settings.folder);
  return result.failed > 0              ? ExitCode::run_time
         : !result.figure_fault.empty() ? ExitCode::input_output
                                        : ExitCode::done;
}

} // namespace

void add_sweep(CLI::App& program, Action& action) {
  const auto options = std::make_shared<SweepOptions>();
  sweep::SweepSettings& settings = options->settings;
  settings.jobs = 0; // as the threads of the machine allow
  CLI::App& command = *program.add_subcommand(
      "sweep", "run a scene over a grid of keys and seeds, with tables and a figure; after a stop or kill the same "
               "command continues");
  command.add_option("GRID", settings.grid, "the grid (TOML): a scene, seeds, and the values of keys")
      ->required()
      ->type_name("");
  command.add_option("-o,--output", settings.folder, "the folder for the results; several programs may share it")
      ->required()
      ->type_name("DIR");
  command.add_option("--jobs", settings.jobs, "concurrent runs (default: threads of the machine / threads of a run)")
      ->transform(whole_number_between(1, max_threads, "a number of runs"));
  command.add_option("--threads", settings.threads_per_run, "threads of each run (default: 1)")
      ->transform(thread_number());
  add_quantities(command, settings.quantities);
  options->units.add_to(command);
  command.add_flag("--tables", settings.tables_only,
                   "start no runs: write the tables and the figure of the finished ones");
  options->talk.add_to(command);
  command.add_flag("--json", options->json, "print the counts and the table of points as JSON");
  examples_of(command, {"keeler sweep grid.toml -o sweep"});
  command.callback([options, &action] {
    requests_from_signals(); // before signals are released
    action = [options] { return carry_out(*options); };
  });
}

} // namespace keeler::cli
