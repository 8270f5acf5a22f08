// The columns of series.csv. Each is declared once, with its name, unit, meaning and function: the header, the rows and
// the table in docs/formats.md are views of this declaration. A new column is one more entry in series_columns.cpp.
#pragma once

#include <keeler/diagnostics/epicyclic_waves.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::runs {

/// One instant of a run, between two steps, with the means over its particles that several columns need.
struct SeriesSample {
  const Scene& scene;
  const Simulation& simulation;
  diagnostics::ParticleMeans means;
  simulation::EnergyBalance balance;
  std::optional<diagnostics::EpicyclicWaves> waves; ///< none: too few particles
  std::optional<gravity::GravityEnergy> gravity;    ///< none: not measured at this instant

  /// Both must outlive the sample. Collective.
  SeriesSample(const Scene& of_scene, const Simulation& of_simulation,
               std::optional<gravity::GravityEnergy> of_gravity = std::nullopt);
};

/// What a column holds: an instantaneous value; a sum or a count of events since the run began; the time integral of a
/// stress.
enum class ColumnKind { value, sum, count, flux };

struct SeriesColumn {
  const char* name; ///< in the header: quantity and unit
  const char* unit;
  const char* plot; ///< "TITLE: CURVE" in plots; columns of one title are curves of one plot
  ColumnKind kind;
  const char* meaning;
  double (*value)(const SeriesSample&);
  bool (*in)(const Scene&) = nullptr; ///< true for scenes that have the column; null: all scenes
  std::function<double(const Simulation&, const Scene&)> own = nullptr; ///< in place of `value`, of the calling program
};

/// Returns all columns, in their order, without the step with which every row begins. The list never changes: what is
/// added later (own_numbers.hpp) is in another one.
const std::vector<SeriesColumn>& series_columns();

/// Returns the names, units and meanings of all columns.
std::vector<quantities::Quantity> series_quantities();

/// Returns the columns that a scene has.
std::vector<SeriesColumn> series_columns_of(const Scene& scene);

/// Returns true if the series has the energy and the stress of gravity.
bool measures_gravity(const Scene& scene);

std::vector<std::string> names_of(std::span<const SeriesColumn> columns);
std::vector<double> values_of(std::span<const SeriesColumn> columns, const SeriesSample& sample);

} // namespace keeler::runs
