#include "results.hpp"

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/occultation.hpp>
#include <keeler/io/series.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/summary.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

namespace keeler::study {

struct FinishedRun {
  const StudyPlan& plan;
  const Scene& scene;
  std::filesystem::path folder;
  quantities::Record summary;
  io::SeriesTable series;

  std::optional<double> told(const std::string& name) const { return number_in(summary, name); }
};

namespace {

using Maybe = std::optional<double>;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
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

// Returns a column's mean over the measured rows of series.csv, nothing without the column or without such rows.
Maybe series_mean(const FinishedRun& run, const std::string& column) {
  const std::vector<double>* const values = run.series.find(column);
  if (!values)
    return std::nullopt;
  const std::vector<double>& orbits = run.series.of("time_orbits");
  assert(orbits.size() == values->size());
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < values->size(); ++k)
    if (orbits[k] >= run.plan.since())
      sum += (*values)[k], count += 1.0;
  return count > 0.0 ? Maybe(sum / count) : std::nullopt;
}

Maybe cpu_per_orbit(const FinishedRun& run) {
  const Maybe cpu = run.told("cpu_s"), orbits = run.told("orbits_done");
  return cpu && orbits && *orbits > 0.0 ? Maybe(*cpu / *orbits) : std::nullopt;
}

Maybe step_of(const FinishedRun& run) {
  return run.scene.time.automatic ? series_mean(run, "step_orbits") : Maybe(run.scene.time.step);
}

Maybe kick_interval(const FinishedRun& run) {
  if (!run.scene.gravity)
    return std::nullopt;
  return run.scene.time.automatic ? series_mean(run, "kick_interval_orbits")
                                  : Maybe(run.scene.time.step * run.scene.gravity->kick_every);
}

// Returns the wall time of a kick: a run on one thread spends `gravity` per step on average.
Maybe kick_cost(const FinishedRun& run) {
  const Maybe gravity = run.told("ns_per_particle_step.gravity"), interval = kick_interval(run), step = step_of(run);
  return gravity && interval && step ? Maybe(*gravity * *interval / *step) : std::nullopt;
}

Maybe transmission(const FinishedRun& run) {
  const std::vector<Patch> patches = runs::load_patches(run.folder, last_orbits).patches;
  assert(!patches.empty());
  return occultation(patches, diagnostics::RayLattice(patches.front().box, rays, footprint), {pi / 2.0, 0.0})
      .transmission.value;
}

StudyNumber told(const std::string& column, const std::string& title, const std::string& name) {
  return {column, title, false, [name](const FinishedRun& run) { return run.told(name); }};
}

std::vector<StudyNumber> make_numbers(const batch::RunQuantities& quantities) {
  std::vector<StudyNumber> all = {{"cpu_s_per_orbit", "processor s per orbit", false, cpu_per_orbit},
                                  told("peak_memory_mb", "memory (MB)", "peak_memory_mb"),
                                  {"step_orbits", "step (orbits)", false, step_of},
                                  {"kick_interval_orbits", "kick interval (orbits)", false, kick_interval},
                                  told("force_error", "force error", "force_error.rms"),
                                  told("unresolved_contacts_share", "unresolved contacts", "unresolved_contacts_share"),
                                  told("finder_gave_up", "", "finder_gave_up"),
                                  told("largest_overlap", "", "largest_overlap"),
                                  {"transmission", "vertical transmission", true, transmission}};
  for (const batch::RunColumn& column : quantities.columns()) {
    const auto title = compared_quantities.find(column.name);
    const bool compared = title != compared_quantities.end();
    all.push_back({column.name, compared ? title->second : std::string(), compared, {}});
  }
  return all;
}

batch::RunNumbers measured(const StudyPlan& plan, const std::vector<StudyNumber>& numbers, const batch::PlannedRun& run,
                           const std::filesystem::path& folder) {
  const FinishedRun finished{plan, run.scene, folder, runs::read_summary(folder),
                             io::read_series(folder / "series.csv")};
  batch::RunNumbers all = plan.quantities.measure(folder, run.scene, plan.since());
  std::vector<std::optional<Estimate>> values;
  std::size_t quantity = 0;
  for (const StudyNumber& number : numbers) {
    if (!number.read)
      values.push_back(all.values[quantity++]);
    else if (const Maybe value = number.read(finished))
      values.push_back(Estimate{*value, unknown});
    else
      values.emplace_back();
  }
  assert(quantity == all.values.size());
  all.values = std::move(values);
  return all;
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
  static const std::vector<StudyNumber> numbers = make_numbers(batch::RunQuantities());
  return numbers;
}

std::vector<StudyNumber> study_numbers(const StudyPlan& plan) {
  std::vector<StudyNumber> numbers = make_numbers(plan.quantities);
  if (plan.kind == SceneStudyKind::mesh)
    numbers.push_back({"kick_ns_per_particle", "a kick (ns per particle)", false, kick_cost});
  return numbers;
}

std::size_t number_at(const std::string& column) {
  const std::vector<StudyNumber>& all = study_numbers();
  const auto found = std::find_if(all.begin(), all.end(), [&](const StudyNumber& n) { return n.column == column; });
  assert(found != all.end());
  return static_cast<std::size_t>(found - all.begin());
}

std::vector<batch::RunRow> measure_runs(const StudyPlan& plan, const std::vector<batch::PlannedRun>& runs,
                                        const batch::RunFolders& folders) {
  const std::vector<StudyNumber> numbers = study_numbers(plan);
  std::vector<batch::RunRow> rows =
      run_rows(runs, folders, [&](const batch::PlannedRun& run, const std::filesystem::path& folder) {
        return measured(plan, numbers, run, folder);
      });
  for (batch::RunRow& row : rows)
    if (row.status == batch::RunStatus::unfinished) {
      row.status = batch::RunStatus::failed;
      row.reason = "not finished";
    }
  return rows;
}

StudyMeans means_of(const StudyChoices& choices, const std::vector<batch::RunRow>& runs,
                    const std::vector<StudyNumber>& numbers) {
  StudyMeans means;
  means.numbers = numbers;
  for (const batch::PointRow& point : point_rows(runs, choices.choices.size(), numbers.size()))
    means.settings.push_back({point, choices.choices[point.point].name, {}});
  means.reference = choices.reference.value_or(smallest_force_error(means.settings));
  assert(means.reference < means.settings.size());
  const std::vector<statistics::Scatter>& reference = means.settings[means.reference].scatter;
  for (std::size_t s = 0; s < means.settings.size(); ++s)
    for (std::size_t n = 0; n < numbers.size(); ++n) // a reference of 0, as a stress without gravity, has no relative
      means.settings[s].from_reference.push_back(    // difference
          s != means.reference && numbers[n].compared && reference[n].mean != 0.0
              ? mean_difference(reference[n], means.settings[s].scatter[n])
              : statistics::MeanDifference{unknown, unknown});
  return means;
}

batch::Json runs_as_json(const StudyPlan& plan, const std::vector<batch::RunRow>& runs) {
  batch::Json rows = batch::Json::array();
  const std::vector<StudyNumber> numbers = study_numbers(plan);
  for (const batch::RunRow& run : runs) {
    batch::Json row = row_of(run, {{"setting", plan.choices.choices[run.run->point].name}});
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      const std::optional<Estimate> value = run.numbers ? run.numbers->values[n] : std::nullopt;
      row[numbers[n].column] = value ? quantities::or_null(value->value) : batch::Json(nullptr);
    }
    rows.push_back(row);
  }
  return rows;
}

batch::Json means_as_json(const StudyMeans& means) {
  batch::Json rows = batch::Json::array();
  const std::vector<statistics::Scatter>& reference = means.settings[means.reference].scatter;
  for (const SettingMeans& setting : means.settings) {
    batch::Json row = {{"setting", setting.name},
                       {"runs", setting.finished},
                       {"reference", setting.point == means.settings[means.reference].point}};
    for (std::size_t n = 0; n < means.numbers.size(); ++n) {
      const std::string& column = means.numbers[n].column;
      const double percent = 100.0 / std::fabs(reference[n].mean);
      row[column] = quantities::or_null(setting.scatter[n].mean);
      row[column + "_bound"] = quantities::or_null(mean_bound(setting.scatter[n]));
      if (!means.numbers[n].compared)
        continue;
      row[column + "_difference_percent"] = quantities::or_null(percent * setting.from_reference[n].difference);
      row[column + "_difference_bound_percent"] = quantities::or_null(percent * setting.from_reference[n].bound);
    }
    rows.push_back(row);
  }
  return rows;
}

} // namespace keeler::study
