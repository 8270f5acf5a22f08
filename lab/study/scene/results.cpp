#include "results.hpp"

#include <keeler/batch/quantities.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/occultation.hpp>
#include <keeler/io/series.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/run_stage.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/summary.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

namespace keeler {
namespace {

namespace fs = std::filesystem;
using Maybe = std::optional<double>;

constexpr std::size_t rays = 200000; // per snapshot
constexpr double footprint = 10.0;   // m; does not change the mean
constexpr double last_orbits = 1.0;  // interval of the snapshots that the rays cross

// The sweep quantities that the report shows, with their titles; in SI, since a study of sizes changes r.
const std::map<std::string, std::string> compared_quantities = {
    {"energy_balance", "loss over stress"},
    {"translational_viscosity_m2_s", "translational viscosity (m²/s)"},
    {"collisional_viscosity_m2_s", "collisional viscosity (m²/s)"},
    {"gravitational_viscosity_m2_s", "gravitational viscosity (m²/s)"},
    {"dispersion_x_m_s", "c_x (m/s)"},
    {"dispersion_z_m_s", "c_z (m/s)"},
    {"collisions_per_particle_orbit", "collisions per particle and orbit"},
    {"wake_wavelength_m", "wake wavelength (m)"},
    {"wake_contrast", "wake contrast"}};

std::vector<StudyNumber> make_numbers(const RunQuantities& quantities) {
  std::vector<StudyNumber> all = {
      {"cpu_s_per_orbit", "processor time per orbit, s", "processor s per orbit", false},
      {"peak_memory_mb", "the most memory in use, 10⁶ bytes", "memory (MB)", false},
      {"step_orbits", "length of a step, orbits; of an automatic one the mean", "step (orbits)", false},
      {"kick_interval_orbits", "from kick to kick, orbits; of an automatic step the mean; only with self-gravity",
       "kick interval (orbits)", false},
      {"force_error", "rms error of self-gravity at the end, over the rms acceleration", "force error", false},
      {"unresolved_contacts_share", "as in `summary.json`", "unresolved contacts", false},
      {"finder_gave_up", "as in `summary.json`", "", false},
      {"largest_overlap", "as in `summary.json`", "", false},
      {"transmission", "vertical, of the snapshots of the last orbit", "vertical transmission", true}};
  for (const RunColumn& column : quantities.columns()) {
    const auto title = compared_quantities.find(column.name);
    const bool compared = title != compared_quantities.end();
    all.push_back({column.name, column.meaning, compared ? title->second : std::string(), compared});
  }
  return all;
}

// Returns a column's mean over the measured rows of series.csv, nothing without the column or without such rows.
Maybe series_mean(const SeriesTable& series, const std::string& column, double since) {
  const std::vector<double>* const values = series.find(column);
  if (!values)
    return std::nullopt;
  const std::vector<double>& orbits = series.of("time_orbits");
  assert(orbits.size() == values->size());
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < values->size(); ++k)
    if (orbits[k] >= since)
      sum += (*values)[k], count += 1.0;
  return count > 0.0 ? Maybe(sum / count) : std::nullopt;
}

Maybe transmission_of(const fs::path& folder) {
  const std::vector<Patch> patches = load_patches(folder, last_orbits).patches;
  assert(!patches.empty());
  return occultation(patches, RayLattice(patches.front().box, rays, footprint), {pi / 2.0, 0.0}).transmission.value;
}

std::vector<Maybe> values_of(const StudyPlan& plan, const PlannedRun& run, const fs::path& folder) {
  const Record summary = read_summary(folder);
  const SeriesTable series = read_series(folder / "series.csv");
  std::map<std::string, Maybe> known;
  const Maybe cpu = number_in(summary, "cpu_s"), orbits = number_in(summary, "orbits_done"),
              memory = number_in(summary, "peak_memory_mb");
  if (cpu && orbits && *orbits > 0.0)
    known["cpu_s_per_orbit"] = *cpu / *orbits;
  if (memory)
    known["peak_memory_mb"] = *memory;
  const Scene& scene = run.scene;
  const auto chosen = [&](const char* column, double fixed) {
    return scene.time.automatic ? series_mean(series, column, plan.since()) : Maybe(fixed);
  };
  known["step_orbits"] = chosen("step_orbits", scene.time.step);
  if (scene.gravity)
    known["kick_interval_orbits"] = chosen("kick_interval_orbits", scene.time.step * scene.gravity->kick_every);
  known["force_error"] = number_in(summary, "force_error.rms");
  for (const char* const key : {"unresolved_contacts_share", "finder_gave_up", "largest_overlap"})
    known[key] = number_in(summary, key);
  known["transmission"] = transmission_of(folder);
  const RunNumbers numbers = plan.quantities.measure(folder, scene, plan.since());
  for (std::size_t k = 0; k < numbers.values.size(); ++k)
    if (const std::optional<Estimate>& value = numbers.values[k]; value && std::isfinite(value->value))
      known[plan.quantities.columns()[k].name] = value->value;
  std::vector<Maybe> values;
  for (const StudyNumber& number : study_numbers(plan.quantities))
    values.push_back(known[number.column]);
  return values;
}

std::size_t smallest_force_error(const std::vector<SettingMeans>& settings) {
  const std::size_t error = number_at("force_error");
  assert(!settings.empty());
  std::size_t best = 0;
  for (std::size_t k = 0; k < settings.size(); ++k)
    if (const double mean = settings[k].scatter[error].mean;
        !std::isnan(mean) && !(settings[best].scatter[error].mean <= mean))
      best = k;
  return best;
}

} // namespace

const std::vector<StudyNumber>& study_numbers() {
  static const std::vector<StudyNumber> numbers = make_numbers(RunQuantities());
  return numbers;
}

std::vector<StudyNumber> study_numbers(const RunQuantities& quantities) {
  return make_numbers(quantities);
}

std::size_t number_at(const std::string& column) {
  const std::vector<StudyNumber>& all = study_numbers();
  const auto found = std::find_if(all.begin(), all.end(), [&](const StudyNumber& n) { return n.column == column; });
  assert(found != all.end());
  return static_cast<std::size_t>(found - all.begin());
}

std::vector<SettingRun> measure_runs(const StudyPlan& plan, const std::vector<PlannedRun>& runs,
                                     const RunFolders& folders) {
  std::vector<SettingRun> measured;
  for (const PlannedRun& run : runs) {
    SettingRun row;
    row.run = &run;
    try {
      if (run_stage(folders.run(run.name)) == RunStage::finished) {
        row.values = values_of(plan, run, folders.run(run.name));
        row.finished = true;
      } else {
        row.reason = folders.failure_of(run.name).value_or("not finished");
      }
    } catch (const Error& error) { // a damaged file affects only its run
      row.reason = error.what();
      row.measurable = false;
    }
    measured.push_back(std::move(row));
  }
  return measured;
}

StudyMeans means_of(const StudyChoices& choices, const std::vector<SettingRun>& runs,
                    const std::vector<StudyNumber>& numbers) {
  const std::size_t count = numbers.size();
  StudyMeans means;
  means.numbers = numbers;
  for (std::size_t s = 0; s < choices.choices.size(); ++s) {
    SettingMeans& setting = means.settings.emplace_back();
    setting.name = choices.choices[s].name;
    std::vector<std::vector<double>> values(count);
    for (const SettingRun& run : runs)
      if (run.run->point == s && !run.values.empty()) {
        assert(run.values.size() == count);
        ++setting.finished;
        for (std::size_t n = 0; n < count; ++n)
          if (run.values[n])
            values[n].push_back(*run.values[n]);
      }
    for (const std::vector<double>& of_number : values)
      setting.scatter.push_back(scatter_of(of_number));
  }
  means.reference = choices.reference.value_or(smallest_force_error(means.settings));
  assert(means.reference < means.settings.size());
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Scatter>& reference = means.settings[means.reference].scatter;
  for (std::size_t s = 0; s < means.settings.size(); ++s)
    for (std::size_t n = 0; n < count; ++n) // a reference of 0, as a stress without gravity, has no relative difference
      means.settings[s].from_reference.push_back(s != means.reference && numbers[n].compared && reference[n].mean != 0.0
                                                     ? mean_difference(reference[n], means.settings[s].scatter[n])
                                                     : MeanDifference{unknown, unknown});
  return means;
}

Json runs_as_json(const StudyPlan& plan, const std::vector<SettingRun>& runs) {
  Json rows = Json::array();
  const std::vector<StudyNumber> numbers = study_numbers(plan.quantities);
  for (const SettingRun& run : runs) {
    Json row;
    row["run"] = run.run->name;
    row["setting"] = plan.choices.choices[run.run->point].name;
    row["seed"] = run.run->seed;
    row["status"] = run.finished ? "finished" : "failed";
    row["reason"] = run.reason.empty() ? Json(nullptr) : Json(run.reason);
    for (std::size_t n = 0; n < numbers.size(); ++n)
      row[numbers[n].column] = run.values.empty() ? Json(nullptr) : or_null(run.values[n]);
    rows.push_back(row);
  }
  return rows;
}

Json means_as_json(const StudyMeans& means) {
  Json rows = Json::array();
  for (std::size_t s = 0; s < means.settings.size(); ++s) {
    const SettingMeans& setting = means.settings[s];
    Json row;
    row["setting"] = setting.name;
    row["runs"] = setting.finished;
    row["reference"] = s == means.reference;
    for (std::size_t n = 0; n < means.numbers.size(); ++n) {
      const std::string& column = means.numbers[n].column;
      const Scatter& reference = means.settings[means.reference].scatter[n];
      const double percent = 100.0 / std::fabs(reference.mean);
      row[column] = or_null(setting.scatter[n].mean);
      row[column + "_bound"] = or_null(mean_bound(setting.scatter[n]));
      if (!means.numbers[n].compared)
        continue;
      row[column + "_difference_percent"] = or_null(percent * setting.from_reference[n].difference);
      row[column + "_difference_bound_percent"] = or_null(percent * setting.from_reference[n].bound);
    }
    rows.push_back(row);
  }
  return rows;
}

} // namespace keeler
