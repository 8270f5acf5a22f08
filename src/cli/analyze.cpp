// keeler analyze: numbers from a snapshot, or averaged over the steady part of a run.
#include "command.hpp"
#include "common_options.hpp"
#include "number_options.hpp"
#include "print.hpp"
#include "results.hpp"
#include "sight_options.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/radial_profile.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/runs/measured_part.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/patch_units.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cassert>
#include <filesystem>
#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

struct AnalyzeOptions {
  std::string path;
  bool json = false;
  diagnostics::AnalysisSettings settings;
  NumberOptions numbers;
  runs::OrbitWindow window;
  std::optional<std::string> profile, csv;
  std::size_t profile_bins = 100;
  SightOptions sights;
  ThreadOption threads;
};

// Writes one row per snapshot, with the numbers of this snapshot only.
void write_snapshots(const fs::path& file, const runs::StoredPatches& stored, const AnalyzeOptions& options) {
  assert(!stored.patches.empty());
  auto rows = nlohmann::ordered_json::array();
  for (const Patch& patch : stored.patches) {
    const runs::TransportReport transport = runs::TransportReport::of_snapshot(patch, stored.gravity);
    rows.push_back(row_of(options.numbers.chosen(record_of(measure({&patch, 1}, transport, options.settings))),
                          options.numbers.system()));
  }
  if (rows.front().is_null())
    throw UsageError("none of the numbers of --only has a column in --csv; lists and words are in --json");
  write_table(file, report::csv_with_gaps(rows));
}

// A row of the profiles. Velocities of an empty bin are unknown.
quantities::Record profile_row(const Patch& patch, const diagnostics::RadialBin& bin,
                               const quantities::PatchUnits& units) {
  namespace unit = quantities::unit;
  const auto speed = [&](const Vec3& velocity, int axis) {
    return bin.count > 0 ? quantities::Value(diagnostics::velocity_si(patch, velocity)[axis])
                         : quantities::Value(quantities::Unknown{});
  };
  return {{{{"time", unit::orbits}, patch.time_orbits},
           {{"x", unit::metres}, bin.x},
           {{"count"}, std::uint64_t{bin.count}},
           {{"surface_density", unit::surface_density}, bin.surface_density},
           {{"optical_depth"}, bin.optical_depth},
           {{"velocity_x", unit::metres_per_second}, speed(bin.velocity, 0)},
           {{"velocity_y", unit::metres_per_second}, speed(bin.velocity, 1)},
           {{"dispersion_x", unit::metres_per_second}, speed(bin.dispersion, 0)},
           {{"dispersion_y", unit::metres_per_second}, speed(bin.dispersion, 1)},
           {{"dispersion_z", unit::metres_per_second}, speed(bin.dispersion, 2)}},
          units};
}

// Writes one row per snapshot and bin.
void write_profiles(const fs::path& file, const std::vector<Patch>& patches, const AnalyzeOptions& options) {
  auto rows = nlohmann::ordered_json::array();
  for (const Patch& patch : patches)
    for (const diagnostics::RadialBin& bin : diagnostics::radial_profile(patch, options.profile_bins))
      rows.push_back(row_of(profile_row(patch, bin, runs::units_of(patch)), options.numbers.system()));
  write_table(file, report::csv_with_gaps(rows));
}

// The output files for tables. One of them may be standard output, which then has no other text.
struct Tables {
  explicit Tables(const AnalyzeOptions& options) : profile(named(options.profile)), csv(named(options.csv)) {
    const auto is_output = [](const auto& file) { return file && is_standard_output(*file) ? 1 : 0; };
    const int count = is_output(profile) + is_output(csv);
    fill_standard_output = count > 0;
    if (count > 1 || (count == 1 && options.json))
      throw UsageError("only one of --csv, --profile and --json can go to standard output; name files for the others");
  }

  std::optional<fs::path> profile, csv;
  bool fill_standard_output = false;

private:
  static std::optional<fs::path> named(const std::optional<std::string>& name) {
    if (!name)
      return std::nullopt;
    const fs::path file = output_named(*name);
    if (!files::is_stream(file))
      files::require_writable_folder(files::folder_of(file), file);
    return file;
  }
};

ExitCode run(const AnalyzeOptions& options) {
  options.threads.apply();
  const Tables tables(options);
  options.numbers.check(runs::measured_quantities());
  const auto [stored, transport] = measured_part(options.path, options.window);
  const quantities::Record numbers =
      options.numbers.chosen(record_of(measure(stored.patches, transport, options.settings)));
  std::optional<Sights> sights;
  if (options.sights.requested())
    sights.emplace(options.sights, stored.patches);
  if (tables.profile)
    write_profiles(*tables.profile, stored.patches, options);
  if (tables.csv)
    write_snapshots(*tables.csv, stored, options);
  if (tables.fill_standard_output)
    return ExitCode::done;
  if (options.json) {
    nlohmann::ordered_json json = json_of(numbers, options.numbers.system());
    if (sights)
      json["sights"] = sights->json();
    print("{}\n", json_text(json, 2));
  } else {
    print("{}", lines_of(numbers, options.numbers.system()));
    if (sights)
      sights->print();
  }
  return ExitCode::done;
}

} // namespace

void add_analyze(CLI::App& program, Action& action) {
  const auto options = std::make_shared<AnalyzeOptions>();
  CLI::App& command = *program.add_subcommand(
      "analyze", "measure a snapshot, or the steady part of a run: viscosities, energy, wakes, structure");
  command.add_option("FILE|DIR", options->path, "a snapshot, or the folder of a run")->required()->type_name("");
  command.add_flag("--json", options->json, "print the numbers as JSON");
  command.add_option("--since", options->window.since, "first orbit (default: the first of the steady part)")
      ->type_name("ORBIT");
  command.add_option("--until", options->window.until, "last orbit (default: the newest)")->type_name("ORBIT");
  command.add_option("--csv", options->csv, "write the numbers of the single snapshots to this file, one row each")
      ->type_name("FILE");
  command
      .add_option("--cluster-gap", options->settings.cluster_gap,
                  "largest gap between touching spheres, over the sum of their radii (default: 0.01)")
      ->check(positive_number(10.0)); // wider gaps put all particles into one cluster, at the cost of all pairs
  command.add_option("--modes", options->settings.radial_modes, "radial modes to measure (default: 4)")
      ->transform(whole_number_between(1, 1000, "a number of modes"));
  CLI::Option* const profile =
      command.add_option("--profile", options->profile, "write radial profiles of all snapshots to this CSV file")
          ->type_name("FILE");
  command.add_option("--bins", options->profile_bins, "bins of the profiles along the radius (default: 100)")
      ->transform(whole_number_between(1, 1e6, "a number of bins"))
      ->needs(profile);
  options->numbers.add_to(command);
  options->sights.add_to(command);
  options->threads.add_to(command);
  examples_of(command, {"keeler analyze wakes", "keeler analyze wakes --since 2 --json",
                        "keeler analyze wakes --only toomre_q,total_viscosity --units gravity",
                        "keeler analyze wakes/snap_000030.hdf --elevation 5,30"});
  command.callback([options, &action] { action = [options] { return run(*options); }; });
}

} // namespace keeler::cli
