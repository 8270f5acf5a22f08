// The columns of moonlets.csv: for each row of the series a row for each moonlet. Declared once, as those of
// series.csv.
#pragma once

#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <span>
#include <string>
#include <vector>

namespace keeler {

/// One moonlet at one instant of a run, between two steps. The values of its columns are collective.
struct MoonletSample {
  const Scene& scene;
  const Simulation& simulation;
  std::size_t k; ///< which, from 0

  Body body() const { return simulation.moonlet(k); }
  const MoonletTrack& track() const { return simulation.state().moonlets[k]; }
};

struct MoonletColumn {
  const char* name; ///< in the header: what and unit
  const char* unit;
  const char* meaning;
  double (*value)(const MoonletSample&);
  bool (*in)(const Scene&) = nullptr; ///< scenes that have the column; null: all
};

/// All columns, in their order. The step, which every row begins with, is none of them.
std::span<const MoonletColumn> moonlet_columns();

/// Those that a scene has: none without moonlets.
std::vector<MoonletColumn> moonlet_columns_of(const Scene& scene);

} // namespace keeler
