// keeler analyze: numbers from a snapshot, or averaged over the part of a run that is steady.
#include "command.hpp"
#include "common_options.hpp"
#include "print.hpp"
#include "profile_file.hpp"
#include "results.hpp"
#include "sight_options.hpp"
#include "structure_report.hpp"
#include "transport_text.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/words.hpp>
#include <keeler/diagnostics/analysis.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/runs/analysis_numbers.hpp>
#include <keeler/runs/measured_part.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

namespace keeler {
namespace {

namespace fs = std::filesystem;

struct AnalyzeOptions {
  std::string path;
  bool json = false;
  AnalysisSettings settings;
  OrbitWindow window;
  std::optional<std::string> profile, csv;
  std::size_t profile_bins = default_profile_bins;
  SightOptions sights;
  ThreadOption threads;
};

void print_wakes(const Analysis& a) {
  const char* const none =
      a.wake_amplitude > 0.0 ? "no wakes stand out of the noise" : "these particles are too few to resolve lambda_cr";
  if (a.wake_pitch_degrees)
    print("wake pitch           {:.1f} degrees, {}\n", std::abs(*a.wake_pitch_degrees),
          *a.wake_pitch_degrees < 0.0 ? "leading" : "trailing");
  else
    print("wake pitch           not known because {}\n", none);
  if (a.wake_spacing_m)
    print("wake spacing         {} m radially = {:.2f} lambda_cr\n", figures(*a.wake_spacing_m, 3),
          *a.wake_spacing_m / a.critical_wavelength_m);
  else
    print("wake spacing         not known because {}\n",
          a.wake_pitch_degrees ? "no second wake stands out within half a box" : none);
  print("wake amplitude       {} in the autocorrelation\n", figures(a.wake_amplitude, 3));
}

void print_text(const Analysis& a, double overlap) {
  const auto& c = a.dispersion_r_omega;
  const auto& v = a.dispersion_m_s;
  print("snapshots            {} up to orbit {}, {}\n", a.snapshots, figures(a.time_orbits, 4),
        counted(a.particle_count, "particle"));
  print("optical depth        {}\n", figures(a.optical_depth, 4));
  print("surface density      {} kg/m^2, lambda_cr {} m\n", figures(a.surface_density_kg_m2, 4),
        figures(a.critical_wavelength_m, 4));
  print("Toomre Q             {:.3g}\n", a.toomre_q);
  print("velocity dispersion  {:.3g} {:.3g} {:.3g} r Omega = {:.3g} {:.3g} {:.3g} m/s\n", c[0], c[1], c[2], v[0], v[1],
        v[2]);
  print("scale height         {:.3g} m, filling factor {:.3g} in the mid-plane\n", a.scale_height_m, a.filling_factor);
  print("largest overlap      {} of a radius sum\n", figures(overlap, 2));
  print_wakes(a);
  print_structure(a);
}

// dispersion_m_s and x: dispersion_x_m_s, as in series.csv.
std::string column_of_axis(const std::string& name, char axis) {
  for (const std::string unit : {"_m_s", "_r_omega"})
    if (name.ends_with(unit))
      return fmt::format("{}_{}{}", name.substr(0, name.size() - unit.size()), axis, unit);
  return fmt::format("{}_{}", name, axis);
}

// A row a snapshot: the numbers of each by itself, [x, y, z] in columns of their own.
void write_snapshots(const fs::path& file, const StoredPatches& stored, const AnalysisSettings& settings) {
  auto rows = nlohmann::ordered_json::array();
  for (const Patch& patch : stored.patches) {
    nlohmann::ordered_json all = numbers_of(analyze(std::span(&patch, 1), settings), largest_overlap(patch).depth), row;
    TransportReport::of_snapshot(patch, stored.gravity).add_to(all, patch);
    for (const auto& [name, value] : all.items())
      if (value.is_primitive() && !name.ends_with("_error_m2_s") && name.find("scatter") == std::string::npos)
        row[name] = value.is_null() ? nlohmann::ordered_json("") : value;
      else if (value.is_array() && value.size() == 3 && value[0].is_number())
        for (std::size_t axis = 0; axis < 3; ++axis)
          row[column_of_axis(name, "xyz"[axis])] = value[axis];
    rows.push_back(row);
  }
  write_table(file, csv_of(rows));
}

// The files that get tables. One of them may go to standard output, in place of what is printed there.
struct Tables {
  explicit Tables(const AnalyzeOptions& options) : profile(named(options.profile)), csv(named(options.csv)) {
    const auto there = [](const auto& file) { return file && is_standard_output(*file) ? 1 : 0; };
    const int asked = there(profile) + there(csv);
    fill_standard_output = asked > 0;
    if (asked > 1 || (asked == 1 && options.json))
      throw UsageError("only one of --csv, --profile and --json can go to standard output; name files for the others");
  }

  std::optional<fs::path> profile, csv;
  bool fill_standard_output = false;

private:
  static std::optional<fs::path> named(const std::optional<std::string>& name) {
    if (!name)
      return std::nullopt;
    const fs::path file = output_named(*name);
    if (!is_stream(file))
      require_writable_folder(folder_of(file), file);
    return file;
  }
};

ExitCode run(const AnalyzeOptions& options) {
  options.threads.apply();
  const Tables tables(options);
  const auto [stored, transport] = measured_part(options.path, options.window);
  double overlap = 0.0;
  for (const Patch& patch : stored.patches)
    overlap = std::max(overlap, largest_overlap(patch).depth);
  const Analysis analysis = analyze(stored.patches, options.settings);
  std::optional<Sights> sights;
  if (options.sights.asked())
    sights.emplace(options.sights, stored.patches);
  if (tables.profile)
    write_profiles(*tables.profile, stored.patches, options.profile_bins);
  if (tables.csv)
    write_snapshots(*tables.csv, stored, options.settings);
  if (tables.fill_standard_output)
    return ExitCode::done;
  if (options.json) {
    nlohmann::ordered_json json = numbers_of(analysis, overlap);
    transport.add_to(json, stored.patches.back());
    if (sights)
      json["sights"] = sights->json();
    print("{}\n", json_text(json, 2));
  } else {
    print_text(analysis, overlap);
    print_transport(transport, stored.patches.back());
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
  command.add_option("--since", options->window.since, "first orbit (default: from where on the run is steady)")
      ->type_name("ORBIT");
  command.add_option("--until", options->window.until, "last orbit (default: the newest)")->type_name("ORBIT");
  command.add_option("--csv", options->csv, "write the numbers of each snapshot by itself to this file, a row each")
      ->type_name("FILE");
  command
      .add_option("--cluster-gap", options->settings.cluster_gap,
                  "largest gap between touching spheres, over the sum of their radii (default: 0.01)")
      ->check(positive_number(10.0)); // wider ones make everything one cluster, in the time of all pairs
  command.add_option("--modes", options->settings.radial_modes, "radial modes to measure (default: 4)")
      ->transform(whole_number_between(1, 1000, "a number of modes"));
  CLI::Option* const profile =
      command.add_option("--profile", options->profile, "write radial profiles of all snapshots to this CSV file")
          ->type_name("FILE");
  command.add_option("--bins", options->profile_bins, "bins of the profiles along the radius (default: 100)")
      ->transform(whole_number_between(1, 1e6, "a number of bins"))
      ->needs(profile);
  options->sights.add_to(command);
  options->threads.add_to(command);
  examples_of(command, {"keeler analyze wakes", "keeler analyze wakes --since 2 --json",
                        "keeler analyze wakes/snap_000030.hdf --elevation 5,30"});
  command.callback([options, &action] { action = [options] { return run(*options); }; });
}

} // namespace keeler
