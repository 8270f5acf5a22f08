// The columns of moonlets.csv: for each row of the series, one row per moonlet. As in series_columns.hpp, each column
// is declared once.
#pragma once

#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cassert>
#include <span>
#include <string>
#include <vector>

namespace keeler::runs {

/// One moonlet at one instant of a run, between two steps. The values of its columns are collective.
struct MoonletSample {
  const Scene& scene;
  const Simulation& simulation;
  std::size_t k; ///< index of the moonlet

  Body body() const { return simulation.moonlet(k); }
  const simulation::MoonletTrack& track() const {
    assert(k < simulation.state().moonlets.size());
    return simulation.state().moonlets[k];
  }
};

struct MoonletColumn {
  const char* name; ///< in the header: quantity and unit
  const char* unit;
  const char* meaning;
  double (*value)(const MoonletSample&);
  bool (*in)(const Scene&) = nullptr; ///< true for scenes that have the column; null: all scenes
};

/// Returns all columns, in their order, without the step with which every row begins.
std::span<const MoonletColumn> moonlet_columns();

/// Returns the columns that a scene has: none without moonlets.
std::vector<MoonletColumn> moonlet_columns_of(const Scene& scene);

} // namespace keeler::runs
