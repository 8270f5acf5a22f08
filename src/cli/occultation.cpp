// keeler occultation: the statistics of a stellar occultation by a snapshot or a run, and the model of wakes that fits
// it.
#include "command.hpp"
#include "common_options.hpp"
#include "light_options.hpp"
#include "messages.hpp"
#include "observed_stars.hpp"
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
#include <keeler/light/occultation_record.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/runs/measured_part.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

constexpr double rad_per_degree = pi / 180.0;

struct OccultationOptions {
  std::string path, observations, section = "rectangle";
  std::vector<double> elevations, azimuths;
  double track_azimuth = 0.0; // degrees
  light::FootprintTrack track;
  bool json = false;
  std::optional<std::string> csv;
  runs::OrbitWindow window;
  ThreadOption threads;
  TalkOption talk;
};

std::vector<light::Bearing> stars_of_grid(const OccultationOptions& options) {
  if (options.elevations.empty())
    throw UsageError("there is no line of sight; give --elevation or --observations");
  std::vector<double> azimuths = options.azimuths;
  if (azimuths.empty())
    for (int k = 0; k < 18; ++k)
      azimuths.push_back(10.0 * k);
  std::vector<light::Bearing> stars;
  for (const double elevation : options.elevations)
    for (const double azimuth : azimuths)
      stars.push_back({elevation * rad_per_degree, azimuth * rad_per_degree});
  return stars;
}

// The fits of both, where there are observations.
struct Fits {
  std::optional<light::FittedWakes> simulated, observed;
};

Fits fits_of(std::span<const light::FootprintStatistics> found, const ObservedStars* observed,
             light::BarSection section) {
  Fits fits;
  fits.simulated = fit_wakes(found, section);
  if (observed)
    fits.observed = fit_wakes(observed->transmissions, section);
  return fits;
}

// What was looked at.
struct Traced {
  std::size_t snapshots = 0, asked = 0; // lines of sight that were asked for
  double since = 0.0, until = 0.0;      // orbits of the first and the last snapshot
};

nlohmann::ordered_json json_of(const OccultationOptions& options, std::span<const light::FootprintStatistics> found,
                               const ObservedStars* observed, const Fits& fits, const Traced& traced) {
  nlohmann::ordered_json json;
  json["snapshots"] = traced.snapshots;
  json["since_orbit"] = traced.since;
  json["until_orbit"] = traced.until;
  json["stopped"] = found.size() < traced.asked;
  json["footprint_m"] = {options.track.length, options.track.width};
  json["track_azimuth_degrees"] = options.track_azimuth;
  json["samples"] = options.track.samples;
  json["lines_of_sight"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < found.size(); ++k) {
    nlohmann::ordered_json one = quantities::json_of(record_of(found[k]));
    one["autocovariance"] = found[k].autocovariance;
    if (observed) {
      one["observed_transmission"] = observed->transmissions[k].transmission;
      one["observed_error"] = observed->has_errors ? nlohmann::ordered_json(observed->transmissions[k].error) : nullptr;
    }
    json["lines_of_sight"].push_back(one);
  }
  json["wake_model"] = fits.simulated ? quantities::json_of(record_of(*fits.simulated)) : nullptr;
  if (observed)
    json["observed_wake_model"] = fits.observed ? quantities::json_of(record_of(*fits.observed)) : nullptr;
  return json;
}

void print_fit(const char* of, const std::optional<light::FittedWakes>& fit) {
  if (!fit) {
    cli::print("wakes {}: no fit; it takes 5 transmissions at 2 azimuths and 2 elevations\n", of);
    return;
  }
  const light::WakeModel &m = fit->model, &e = fit->errors;
  cli::print("wakes {}: H/W {:.3f} +- {:.2g}, S/W {:.3f} +- {:.2g}, gap optical depth {:.4f} +- {:.2g}, azimuth {:.1f} "
             "+- {:.2g} degrees; chi-square {} for {}\n",
             of, m.height, e.height, m.gap, e.gap, m.gap_depth, e.gap_depth, m.azimuth / rad_per_degree,
             e.azimuth / rad_per_degree, format_number(fit->chi_square, 4),
             pluralize(fit->freedom, "degree") + " of freedom");
}

void print_occultation(const OccultationOptions& options, std::span<const light::FootprintStatistics> found,
                       const ObservedStars* observed, const Fits& fits) {
  cli::print("samples of {} x {} m, along the azimuth {}\n", format_number(options.track.length, 4),
             format_number(options.track.width, 4), format_number(options.track_azimuth, 4));
  for (std::size_t k = 0; k < found.size(); ++k) {
    const light::FootprintStatistics& one = found[k];
    const auto maybe = [](const std::optional<double>& value) { return value ? format_number(*value, 4) : "unknown"; };
    const std::string skewness = one.skewness ? format_number(one.skewness->value, 4) : "unknown";
    cli::print("  B {:<5} phi {:<5} T {:.4f} +- {:<7.2g} tau {:<8} variance {:<9.3g} +- {:<7.2g} skewness {:<7} "
               "radius {} m{}\n",
               format_number(one.star.elevation / rad_per_degree, 4),
               format_number(one.star.azimuth / rad_per_degree, 4), one.transmission.value, one.transmission.error,
               maybe(one.optical_depth), one.variance.value, one.variance.error, skewness, maybe(one.effective_radius),
               observed ? fmt::format("; observed T {:.4f}", observed->transmissions[k].transmission) : "");
  }
  print_fit("here", fits.simulated);
  if (observed)
    print_fit("observed", fits.observed);
}

bool is_overhead(const light::Bearing& star) {
  return std::fabs(std::cos(star.elevation)) < 1e-9;
}

ExitCode run(OccultationOptions options) {
  options.threads.apply();
  options.talk.say_program();
  light::require_tracer();
  std::optional<fs::path> table;
  if (options.csv) {
    table = output_named(*options.csv);
    if (is_standard_output(*table) && options.json)
      throw UsageError("only one of --csv and --json can go to standard output; name a file for the table");
    if (!files::is_stream(*table))
      files::require_writable_folder(files::folder_of(*table), *table);
  }
  options.track.azimuth = options.track_azimuth * rad_per_degree;
  std::optional<ObservedStars> table_of_stars;
  const ObservedStars* observed = nullptr;
  if (!options.observations.empty())
    observed = &table_of_stars.emplace(read_observed_stars(options.observations));
  std::vector<light::Bearing> stars;
  if (observed)
    for (const light::StarTransmission& one : observed->transmissions)
      stars.push_back(one.star);
  else
    stars = stars_of_grid(options);
  if (std::count_if(stars.begin(), stars.end(), is_overhead) > 1)
    options.talk.notice()(
        "at an elevation of 90 degrees an azimuth has no meaning: lines of sight that differ in it alone "
        "are the same");
  std::vector<light::FootprintStatistics> found;
  Traced traced{.asked = stars.size()};
  {
    const Interruptible by_signals(requests_from_signals().stop);
    const runs::StoredPatches stored = runs::measured_part(options.path, options.window).stored;
    traced.snapshots = stored.patches.size();
    traced.since = stored.patches.front().time_orbits, traced.until = stored.patches.back().time_orbits;
    if (options.talk.verbose)
      say(fmt::format("{} at {}: {} samples of {} rays each", patches_in_words(stored.patches),
                      pluralize(stars.size(), "line") + " of sight",
                      options.track.tracks * options.track.samples * stored.patches.size(), options.track.rays));
    ProgressLine line(options.talk);
    found = footprint_statistics(stored.patches, stars, options.track,
                                 [&line](const Progress& progress) { line.show_if_long(progress); });
  }
  if (found.empty())
    throw Error(ExitCode::run_time, "stopped before a line of sight was traced (on request); nothing is written");
  const Fits fits = fits_of(found, observed,
                            options.section == "ellipse" ? light::BarSection::ellipse : light::BarSection::rectangle);
  if (table) {
    auto rows = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < found.size(); ++k) {
      rows.push_back(quantities::row_of(record_of(found[k])));
      if (observed)
        rows.back()["observed_transmission"] = observed->transmissions[k].transmission;
    }
    write_table(*table, report::csv_with_gaps(rows));
  }
  if (options.json)
    print("{}\n", json_text(json_of(options, found, observed, fits, traced), 2));
  else if (!table || !is_standard_output(*table))
    print_occultation(options, found, observed, fits);
  if (found.size() == stars.size())
    return ExitCode::done;
  options.talk.notice()(fmt::format("stopped (on request) with {} of {} of sight; these are given", found.size(),
                                    pluralize(stars.size(), "line")));
  return ExitCode::stopped;
}

} // namespace

void add_occultation(CLI::App& program, Action& action) {
  const auto options = std::make_shared<OccultationOptions>();
  CLI::App& command = *program.add_subcommand(
      "occultation",
      "occult a star: statistics of a moving footprint, and the model of wakes that fits the transmission");
  command.add_option("FILE|DIR", options->path, "a snapshot, or the folder of a run")->required()->type_name("");
  CLI::Option* const elevation =
      command
          .add_option("--elevation", options->elevations,
                      "elevations of the star above the ring plane (degrees, separated by commas)")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(number_between(lowest_star, 90.0, "an elevation"));
  CLI::Option* const azimuth =
      command
          .add_option("--azimuth", options->azimuths,
                      "azimuths of the star, from the radius to the orbital motion (default: every 10 in half a turn)")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(number_between(-360.0, 360.0, "an azimuth"));
  command
      .add_option(
          "--observations", options->observations,
          "a table of occultations: columns elevation, azimuth or longitude, transmission or normal_optical_depth, "
          "and error of the transmission if it is known")
      ->type_name("FILE")
      ->excludes(elevation)
      ->excludes(azimuth);
  command
      .add_option("--length", options->track.length, "that the star moves in the ring during a sample, m (default: 10)")
      ->check(positive_number(1e6));
  command.add_option("--width", options->track.width, "of the footprint across its motion, m (default: 10)")
      ->check(positive_number(1e6));
  command
      .add_option("--track", options->track_azimuth, "azimuth of the motion, degrees (default: 0, along the radius)")
      ->check(number_between(-360.0, 360.0, "an azimuth"));
  command.add_option("--tracks", options->track.tracks, "tracks at random places, per snapshot (default: 100)")
      ->transform(whole_number_between(2, 1e6, "a number of tracks"));
  command.add_option("--samples", options->track.samples, "samples of a track (default: 64)")
      ->transform(whole_number_between(2, 1e5, "a number of samples"));
  command.add_option("--rays", options->track.rays, "rays of a sample (default: 32)")
      ->transform(whole_number_between(4, 1e5, "a number of rays"));
  one_of(command.add_option("--section", options->section, "of the bars of the model (default: rectangle)"),
         {"rectangle", "ellipse"});
  command.add_option("--since", options->window.since, "first orbit (default: the first of the steady part)")
      ->type_name("ORBIT");
  command.add_option("--until", options->window.until, "last orbit (default: the newest)")->type_name("ORBIT");
  command.add_flag("--json", options->json, "print the numbers as JSON");
  command.add_option("--csv", options->csv, "write the numbers to this file, one row per line of sight")
      ->type_name("FILE");
  options->threads.add_to(command);
  options->talk.add_to(command);
  examples_of(command, {"keeler occultation wakes --elevation 10,20,40",
                        "keeler occultation wakes --elevation 66.7 --azimuth 0 --length 12 --width 8 --json",
                        "keeler occultation wakes --observations uvis.csv --section ellipse --csv beside.csv"});
  command.callback([options, &action] {
    requests_from_signals(); // before signals are released
    action = [options] { return run(*options); };
  });
}

} // namespace keeler::cli
