// keeler photometry: the light that an observer sees of a snapshot, or of the steady part of a run.
#include "command.hpp"
#include "common_options.hpp"
#include "light_options.hpp"
#include "messages.hpp"
#include "photometry_figure.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "talk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/light/photometry_record.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/runs/measured_part.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

constexpr double max_photometry_rays = 1e9;

struct PhotometryOptions {
  std::string path;
  bool json = false;
  std::optional<std::string> csv, figure;
  SightGrid grid;
  LawOptions law;
  light::PhotometrySettings settings;
  runs::OrbitWindow window;
  ThreadOption threads;
  TalkOption talk;
};

// What was looked at.
struct Measured {
  std::size_t snapshots = 0, asked = 0; // sights that were asked for
  double since = 0.0, until = 0.0;      // orbits of the first and the last snapshot
};

nlohmann::ordered_json json_of(const PhotometryOptions& options, const Measured& measured,
                               std::span<const light::Photometry> found) {
  nlohmann::ordered_json json;
  json["law"] = options.law.name;
  json["albedo"] = options.law.albedo;
  json["snapshots"] = measured.snapshots;
  json["since_orbit"] = measured.since;
  json["until_orbit"] = measured.until;
  json["stopped"] = found.size() < measured.asked;
  json["sights"] = nlohmann::ordered_json::array();
  for (const light::Photometry& one : found)
    json["sights"].push_back(quantities::json_of(record_of(one)));
  json["azimuthal_asymmetry"] = nlohmann::ordered_json::array();
  for (const light::AzimuthGroup& group : light::azimuth_groups(found))
    json["azimuthal_asymmetry"].push_back(quantities::json_of(record_of(group)));
  return json;
}

void print_text(const PhotometryOptions& options, std::size_t snapshots, std::span<const light::Photometry> found) {
  cli::print("law {}, albedo {}; {}, {} rays each\n", options.law.name, format_number(options.law.albedo),
             pluralize(snapshots, "snapshot"), found.empty() ? 0 : found.front().rays);
  cli::print("{:>7} {:>7} {:>7} {:>7} {:>8}  {:<21} {:<9} {:<10} {:<10} {}\n", "B", "phi", "B'", "phase", "longit.",
             "I/F +- by rays", "scatter", "single", "multiple", "T");
  for (const light::Photometry& one : found) {
    const quantities::Record record = record_of(one);
    const auto angle = [&](const char* name) { return format_number(*number_in(record, name), 4); };
    cli::print("{:>7} {:>7} {:>7} {:>7} {:>8}  {:<8.5f} +- {:<9.2g} {:<9} {:<10.5f} {:<10.5f} {:.5f}\n",
               angle("observer_elevation"), angle("observer_azimuth"), angle("sun_elevation"), angle("phase"),
               angle("ring_longitude"), one.reflectance.value, one.reflectance.error,
               one.scatter ? format_number(*one.scatter, 2) : "-", one.single.value, one.multiple.value,
               one.transmission.value);
  }
  for (const light::AzimuthGroup& group : light::azimuth_groups(found))
    if (group.asymmetry)
      cli::print("B {}, phase {}: asymmetry {:.4f} +- {:.2g}, darkest at the longitudes {:.1f} and {:.1f}\n",
                 format_number(*number_in(record_of(group), "observer_elevation"), 4),
                 format_number(*number_in(record_of(group), "phase"), 4), group.asymmetry->amplitude,
                 group.asymmetry->error, group.asymmetry->minimum_longitude * 180.0 / pi,
                 group.asymmetry->minimum_longitude * 180.0 / pi + 180.0);
}

std::optional<fs::path> table_file(const PhotometryOptions& options) {
  if (!options.csv)
    return std::nullopt;
  fs::path file = output_named(*options.csv);
  if (is_standard_output(file) && options.json)
    throw UsageError("only one of --csv and --json can go to standard output; name a file for the table");
  if (!files::is_stream(file))
    files::require_writable_folder(files::folder_of(file), file);
  return file;
}

ExitCode run(PhotometryOptions options) {
  options.threads.apply();
  options.talk.say_program();
  light::require_tracer();
  const std::optional<fs::path> table = table_file(options);
  const std::optional<PhotometryFigureFile> figure =
      options.figure ? std::optional<PhotometryFigureFile>(*options.figure) : std::nullopt;
  options.settings.law = options.law.law();
  const std::vector<light::Sight> sights = options.grid.sights();
  std::vector<light::Photometry> found;
  Measured measured{.asked = sights.size()};
  {
    const Interruptible by_signals(requests_from_signals().stop);
    const runs::StoredPatches stored = runs::measured_part(options.path, options.window).stored;
    measured.snapshots = stored.patches.size();
    measured.since = stored.patches.front().time_orbits, measured.until = stored.patches.back().time_orbits;
    if (options.talk.verbose)
      say(fmt::format("{} at {}, law {}, albedo {}: {}", patches_in_words(stored.patches),
                      pluralize(sights.size(), "sight"), options.law.name, format_number(options.law.albedo),
                      options.settings.error
                          ? fmt::format("rays until the error of I/F is {:g}", *options.settings.error)
                          : pluralize(options.settings.rays, "ray") + " per sight and snapshot"));
    ProgressLine line(options.talk);
    found = light::photometry(stored.patches, sights, options.settings,
                              [&line](const Progress& progress) { line.show_if_long(progress); });
  }
  const bool cut_short = found.size() < sights.size() || interrupted();
  if (found.empty())
    throw Error(ExitCode::run_time, "stopped before a sight was traced (on request); nothing is written");
  if (table) {
    auto rows = nlohmann::ordered_json::array();
    for (const light::Photometry& one : found) {
      const quantities::Record record = record_of(one);
      nlohmann::ordered_json row = quantities::row_of(record);
      for (const quantities::Entry& entry : record.entries)
        if (const auto* const number = std::get_if<quantities::Uncertain>(&entry.value))
          row[entry.quantity.spread_name()] = quantities::or_null(number->spread);
      rows.push_back(row);
    }
    write_table(*table, report::csv_with_gaps(rows));
  }
  if (figure)
    figure->write(found);
  if (options.json)
    print("{}\n", json_text(json_of(options, measured, found), 2));
  else if (!table || !is_standard_output(*table))
    print_text(options, measured.snapshots, found);
  if (!cut_short)
    return ExitCode::done;
  options.talk.notice()(fmt::format("stopped (on request) with {} of {}; these are given", found.size(),
                                    pluralize(sights.size(), "sight")));
  return ExitCode::stopped;
}

} // namespace

void add_photometry(CLI::App& program, Action& action) {
  const auto options = std::make_shared<PhotometryOptions>();
  CLI::App& command = *program.add_subcommand(
      "photometry", "trace sunlight through a snapshot, or the steady part of a run: brightness I/F and transmission");
  command.add_option("FILE|DIR", options->path, "a snapshot, or the folder of a run")->required()->type_name("");
  options->grid.add_to(command);
  options->law.add_to(command);
  CLI::Option* const rays =
      command.add_option("--rays", options->settings.rays, "rays per sight and snapshot (default: 100000)")
          ->transform(whole_number_between(1, max_photometry_rays, "a number of rays"));
  command
      .add_option("--error", options->settings.error,
                  "trace until the relative standard error of I/F is this, such as 0.01")
      ->check(number_between(1e-5, 1.0, "an error"))
      ->excludes(rays);
  command.add_option("--seed", options->settings.seed, "of the random numbers (default: 1)")
      ->transform(whole_number_between(0, 1e15, "a seed"));
  command.add_option("--since", options->window.since, "first orbit (default: the first of the steady part)")
      ->type_name("ORBIT");
  command.add_option("--until", options->window.until, "last orbit (default: the newest)")->type_name("ORBIT");
  command.add_flag("--json", options->json, "print the numbers as JSON");
  command.add_option("--csv", options->csv, "write the numbers to this file, one row per sight")->type_name("FILE");
  command
      .add_option("--figure", options->figure, "draw I/F against ring longitude, or against phase (.svg, .png or .pdf)")
      ->type_name("FILE");
  options->threads.add_to(command);
  options->talk.add_to(command);
  examples_of(command, {"keeler photometry wakes --elevation 10,20 --figure asymmetry.svg",
                        "keeler photometry wakes --elevation 20 --azimuth 0 --phase 0.5,2,6,40,90,140 --error 0.01",
                        "keeler photometry wakes --elevation -20 --sun-elevation 15 --phase 60 --json",
                        "keeler photometry wakes --observations hst.csv --law lambert --albedo 0.6 --csv found.csv"});
  command.callback([options, &action] {
    requests_from_signals(); // before signals are released
    action = [options] { return run(*options); };
  });
}

} // namespace keeler::cli
