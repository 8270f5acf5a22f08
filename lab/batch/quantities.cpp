#include <keeler/batch/quantities.hpp>

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/clusters.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/patch_units.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/summary.hpp>
#include <keeler/statistics/time_series.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace keeler::batch {

struct RunQuantities::Source {
  io::SeriesTable series;
  std::vector<std::size_t> rows; ///< indices in the measured part
  Patch last;
  quantities::PatchUnits units;
  quantities::Record transport;
  quantities::Record wakes;    ///< empty without self-gravity
  quantities::Record analysis; ///< all quantities of keeler analyze; empty if none was requested
  quantities::Record summary;  ///< empty if none of it was requested
};

namespace {

namespace fs = std::filesystem;
using Maybe = std::optional<Estimate>;
using Source = RunQuantities::Source;

constexpr double no_error = std::numeric_limits<double>::quiet_NaN();

// Returns a plain number of a record, or a truth value as 1 or 0. The scatter of snapshots is not used as the error of
// the mean.
Maybe estimate_in(const quantities::Record& record, const quantities::Quantity& quantity) {
  const quantities::Value* const value = find_value(record, quantity.name);
  if (const bool* const yes = value ? std::get_if<bool>(value) : nullptr)
    return Estimate{*yes ? 1.0 : 0.0, no_error};
  const std::optional<double> number = number_in(record, quantity.name);
  if (!number)
    return std::nullopt;
  const auto* const uncertain = std::get_if<quantities::Uncertain>(value);
  return Estimate{*number, uncertain && quantity.spread == quantities::Spread::error
                               ? uncertain->spread.value_or(no_error)
                               : no_error};
}

Maybe axis_in(const quantities::Record& record, const std::string& name, std::size_t axis) {
  const quantities::Value* const value = find_value(record, name);
  const auto* const vector = value ? std::get_if<std::vector<double>>(value) : nullptr;
  return vector && axis < vector->size() ? Maybe({(*vector)[axis], no_error}) : std::nullopt;
}

Maybe column_mean(const Source& run, const std::string& column) {
  const std::vector<double>* const all = run.series.find(column);
  if (!all)
    return std::nullopt;
  assert(run.rows.empty() || run.rows.back() < all->size());
  std::vector<double> values;
  for (const std::size_t row : run.rows)
    values.push_back((*all)[row]);
  return statistics::block_mean(values);
}

// Returns `factor` times the mean increase of a column per orbit, over `count`.
Maybe rate_of(const Source& run, const std::string& column, double factor = 1.0, double count = 1.0) {
  const std::vector<double>* const sums = run.series.find(column);
  if (!sums)
    return std::nullopt;
  const std::vector<double>& orbits = run.series.of("time_orbits");
  assert(run.rows.size() >= 2 && count > 0.0);
  std::vector<double> rates;
  for (std::size_t k = 0; k + 1 < run.rows.size(); ++k) {
    const std::size_t a = run.rows[k], b = run.rows[k + 1];
    rates.push_back(factor * ((*sums)[b] - (*sums)[a]) / (count * (orbits[b] - orbits[a])));
  }
  return statistics::block_mean(rates);
}

// Returns collisions per particle and orbit; each collision counts for both particles.
Maybe collision_rate(const Source& run) {
  return rate_of(run, "collisions", 2.0, static_cast<double>(run.last.size()));
}

// Measures the last snapshot only, so the error is unknown.
Maybe largest_cluster(const Source& run) {
  if (run.wakes.entries.empty())
    return std::nullopt;
  const diagnostics::ClusterAnalysis clusters =
      diagnostics::analyze_clusters(std::span(&run.last, 1), diagnostics::default_cluster_gap);
  return Estimate{clusters.largest_mass_fraction, no_error};
}

std::vector<std::size_t> rows_between(const std::vector<double>& orbits, double since, double until) {
  constexpr double rounding = 1e-9;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < orbits.size(); ++k)
    if (orbits[k] >= since - rounding && orbits[k] <= until + rounding)
      rows.push_back(k);
  return rows;
}

} // namespace

std::vector<quantities::Quantity> RunQuantities::known() {
  return joined(joined(runs::measured_quantities(), runs::summary_quantities()), runs::series_quantities());
}

RunQuantities::RunQuantities(const std::vector<std::string>& extra, std::optional<quantities::UnitSystem> units)
    : units_(units) {
  const std::vector<quantities::Quantity> measured = runs::measured_quantities();
  const auto of_analyze = [&](const char* name) { return *find_quantity(measured, name); };
  for (const char* const name : {"translational_viscosity", "collisional_viscosity", "gravitational_viscosity",
                                 "total_viscosity", "loss_viscosity", "energy_balance"})
    add_measured(of_analyze(name), &Source::transport);
  for (const char* const axis : {"dispersion_x", "dispersion_y", "dispersion_z"})
    add_series_mean(fmt::format("{}_m_s", axis), {axis,
                                                  quantities::unit::metres_per_second,
                                                  {},
                                                  {},
                                                  quantities::Spread::error,
                                                  quantities::Forms::si_and_radius});
  add_series_mean("dispersion_without_waves_x_m_s",
                  {"dispersion_without_waves_x", quantities::unit::metres_per_second});
  add_series_mean("epicyclic_wave_fraction", {"epicyclic_wave_fraction"});
  add_series_mean("scale_height_m", {"scale_height", quantities::unit::metres});
  add_series_mean("mean_spin_omega", {"mean_spin", quantities::unit::omega});
  add_series_mean("spin_energy_ratio", {"spin_energy_ratio"});
  add({"collisions_per_particle_orbit", quantities::unit::none, {}, "collisions faster than v_cut"}, collision_rate);
  for (const char* const name : {"wake_amplitude", "wake_wavelength", "wake_angle"})
    add_measured(of_analyze(name), &Source::wakes);
  add({"largest_cluster_mass_share",
       quantities::unit::none,
       {},
       "mass fraction of the largest cluster of touching spheres, in the last snapshot; with self-gravity"},
      largest_cluster);
  add_measured(of_analyze("wake_contrast"), &Source::wakes);
  require_names(known(), extra);
  for (const std::string& name : extra)
    if (!add_named(name, measured, &Source::analysis) &&
        !add_named(name, runs::summary_quantities(), &Source::summary) && !add_column_of_series(name))
      throw UsageError(
          fmt::format("'{}' is not a plain number, so it cannot be a column of a table; leave it out", name));
}

// Adds the quantities with that name, unless they are columns already. Returns false if no plain number has it.
bool RunQuantities::add_named(const std::string& name, std::span<const quantities::Quantity> all,
                              quantities::Record Source::*record) {
  bool has_column = false;
  for (const quantities::Quantity& quantity : all) {
    if (!quantity.is_called(name) || quantity.shape == quantities::Shape::other)
      continue;
    has_column = true;
    if (find(quantity.full_name()))
      continue;
    (record == &Source::summary ? summarises_ : analyzes_) = true;
    add_measured(quantity, record);
  }
  return has_column;
}

bool RunQuantities::add_column_of_series(const std::string& name) {
  for (const runs::SeriesColumn& column : runs::series_columns()) {
    if (column.name != name)
      continue;
    if (column.kind == runs::ColumnKind::value)
      add_series_mean(name, {name, quantities::unit::unnamed(column.unit)});
    else
      add({name + "_per_orbit",
           quantities::unit::unnamed(column.unit),
           {},
           fmt::format("mean increase per orbit: {}", column.meaning)},
          [name](const Source& run) { return rate_of(run, name); });
    return true;
  }
  return false;
}

void RunQuantities::add(const quantities::Quantity& quantity, const Reading& number) {
  const std::vector<quantities::UnitSystem> systems = quantity.systems(units_);
  for (const quantities::UnitSystem system : systems) {
    const quantities::Unit in = unit_in(quantity.unit, system);
    quantities::Quantity with_error = quantity; // every column has a column for its error
    with_error.spread = quantities::Spread::error;
    columns_.push_back({quantity.full_name(system), with_error.spread_name(system),
                        system != systems.front() ? fmt::format("as above, in {}", in.text)
                        : in.text.empty()         ? quantity.meaning
                                                  : fmt::format("{}; {}", quantity.meaning, in.text),
                        quantity});
    readings_.push_back([number, system, unit = quantity.unit](const Source& run) -> Maybe {
      const Maybe value = number(run);
      const double size = size_of_unit(unit, system, run.units);
      return value ? Maybe({value->value / size, value->error / size}) : std::nullopt;
    });
  }
}

void RunQuantities::add_measured(const quantities::Quantity& quantity, quantities::Record Source::*record) {
  if (quantity.shape != quantities::Shape::vector)
    add(quantity, [record, quantity](const Source& run) { return estimate_in(run.*record, quantity); });
  else
    for (const std::size_t axis : {0U, 1U, 2U})
      if (const quantities::Quantity one = quantity.along(axis); !find(one.full_name()))
        add(one, [record, axis, name = quantity.name](const Source& run) { return axis_in(run.*record, name, axis); });
}

void RunQuantities::add_series_mean(const std::string& column, quantities::Quantity quantity) {
  const std::vector<quantities::Quantity> of_series = runs::series_quantities();
  quantity.meaning = find_quantity(of_series, column)->meaning;
  add(quantity, [column](const Source& run) { return column_mean(run, column); });
}

std::optional<std::size_t> RunQuantities::find(const std::string& name) const {
  auto found =
      std::find_if(columns_.begin(), columns_.end(), [&](const RunColumn& column) { return column.name == name; });
  if (found == columns_.end())
    found = std::find_if(columns_.begin(), columns_.end(), [&](const RunColumn& column) {
      return column.quantity.is_called(name) || column.name == name + "_per_orbit";
    });
  return found == columns_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - columns_.begin()));
}

RunNumbers RunQuantities::measure(const fs::path& folder, const Scene& scene, std::optional<double> since) const {
  RunNumbers numbers;
  assert(readings_.size() == columns_.size());
  numbers.values.resize(columns_.size());
  Source run;
  run.series = io::read_series(folder / "series.csv");
  run.last = std::move(runs::load_newest_patch(folder).patches.front());
  numbers.particle_count = run.last.size();
  const runs::TransportReport report = runs::TransportReport::of_series(
      run.series, runs::RingScale::of(run.last, !scene.external_forces.empty(), scene.gravity.has_value()),
      {since, std::nullopt});
  if (!report.transport())
    return numbers;
  const double first = report.transport()->since_orbit, until = report.transport()->until_orbit;
  run.rows = rows_between(run.series.of("time_orbits"), first, until);
  run.units = runs::units_of(run.last);
  run.transport = record_of(report, run.units);
  if (summarises_)
    run.summary = runs::read_summary(folder);
  if (analyzes_ || scene.gravity) {
    const std::vector<Patch> patches = runs::load_patches(folder, std::max(0.0, run.last.time_orbits - first)).patches;
    if (analyzes_)
      run.analysis = record_of(runs::measure(patches, report));
    if (scene.gravity)
      run.wakes = analyzes_ ? run.analysis : runs::wakes_of(patches);
  }
  numbers.since_orbit = first;
  numbers.until_orbit = until;
  numbers.steady = report.transport()->steady;
  for (std::size_t k = 0; k < readings_.size(); ++k)
    numbers.values[k] = readings_[k](run);
  return numbers;
}

} // namespace keeler::batch
