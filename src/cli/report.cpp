// keeler report: writes a page about a run.
#include "command.hpp"
#include "common_options.hpp"
#include "number_options.hpp"
#include "progress_line.hpp"
#include "results.hpp"

#include <keeler/files/files.hpp>
#include <keeler/run_report/run_report.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::string folder;
  std::optional<std::string> output;
  run_report::RunReportOptions page;
  UnitsOption units;
  ThreadOption threads;
};

ExitCode report(ReportOptions& options) {
  options.threads.apply();
  const fs::path file = options.output ? output_named(*options.output) : fs::path(options.folder) / "report.html";
  if (!fs::is_directory(options.folder))
    throw UsageError(fmt::format("no report of '{}': it is not a folder; name the folder of a run", options.folder));
  require_replaceable(file, "a report", "<!DOCTYPE html>");
  options.page.units = options.units.system();
  std::string page;
  {
    ProgressLine line;
    options.page.progress = [&line](const Progress& progress) { line.show_if_long(progress); };
    page = run_report::run_report(options.folder, options.page);
  }
  files::write_text(file, page);
  print_written(file);
  return ExitCode::done;
}

} // namespace

void add_report(CLI::App& program, Action& action) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App& command = *program.add_subcommand(
      "report", "write a page about a run: pictures, a view in 3-D, plots, numbers, scene, cost");
  command.add_option("DIR", options->folder, "the folder of the run")->required()->type_name("");
  command.add_option("-o,--output", options->output, "the file to write (default: report.html in the folder)")
      ->type_name("FILE");
  command
      .add_option("--snapshots", options->page.snapshots,
                  "largest number of snapshots in the 3-D view, evenly spaced in the run (default: 8)")
      ->transform(whole_number_between(1, 1000, "a number of snapshots"));
  options->units.add_to(command);
  options->threads.add_to(command);
  examples_of(command, {"keeler report wakes", "keeler report wakes --snapshots 20 -o page.html"});
  command.callback([options, &action] { action = [options] { return report(*options); }; });
}

} // namespace keeler::cli
