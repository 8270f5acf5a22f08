// The columns of series.csv. Each is declared once, with its name, unit, meaning and how it is computed: the header,
// the rows and the table in docs/formats.md come from here. A new column is one more entry in series_columns.cpp.
#pragma once

#include <keeler/diagnostics/epicyclic_waves.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/gravity/fft.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler {

/// One instant of a run, between two steps, and what its particles give.
struct SeriesSample {
  const Scene& scene;
  const Simulation& simulation;
  ParticleMeans means;
  EnergyBalance balance;
  std::optional<EpicyclicWaves> waves;  ///< none: too few particles
  std::optional<GravityEnergy> gravity; ///< none: not measured at this instant

  /// Both must outlive it. Collective.
  SeriesSample(const Scene& of_scene, const Simulation& of_simulation,
               std::optional<GravityEnergy> of_gravity = std::nullopt);
};

/// What a column is at an instant: a value; a sum or a number of events since the run began; the integral of a stress.
enum class Course { value, sum, count, flux };

struct SeriesColumn {
  const char* name; ///< in the header: what and unit
  const char* unit;
  const char* plot; ///< "TITLE: CURVE" in plots; columns of one title are curves of one plot
  Course course;
  const char* meaning;
  double (*value)(const SeriesSample&);
  bool (*in)(const Scene&) = nullptr; ///< scenes that have the column; null: all
};

/// All columns, in their order. The step, which every row begins with, is none of them.
std::span<const SeriesColumn> series_columns();

/// Their names, units and meanings.
std::vector<Quantity> series_quantities();

/// Those that a scene has.
std::vector<SeriesColumn> series_columns_of(const Scene& scene);

/// Whether rows of the series have the energy and the stress of gravity.
bool measures_gravity(const Scene& scene);

std::vector<std::string> names_of(std::span<const SeriesColumn> columns);
std::vector<double> values_of(std::span<const SeriesColumn> columns, const SeriesSample& sample);

} // namespace keeler
