// Time and error of a gravity solve, for every solver and setting: a patch of Saturn's A ring with the physics of
// examples/a-ring-wakes.
#pragma once

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/diagnostics/force_error.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace keeler::bench {

struct GravityBenchSettings {
  std::size_t count = 100000;    ///< rounded to whole tiles
  std::string state = "settled"; ///< one of gravity_state_names()
  std::string solver;            ///< empty: all, `direct` only up to 10000 particles
  int repeats = 5;
  std::function<void(const Progress&)> progress; ///< may be empty
};

/// Results of one solver with one setting. The time is the median over the repeats, including sorting and building the
/// tree or mesh: processor time on one thread, wall time on several.
struct GravityBenchRow {
  GravityChoice choice;
  diagnostics::ForceErrors errors; ///< relative to the sum over all pairs and images, on the sample
  double net_force = 0.0;          ///< |Σ m a| / Σ m |a|, of all particles
  double ns_per_particle = 0.0;

  /// Returns all numbers with their names in JSON and CSV.
  std::vector<std::pair<std::string, double>> numbers() const;
};

struct GravityBench {
  std::vector<GravityBenchRow> rows;
  std::size_t count = 0; ///< particles of the patch
  double size_x_m = 0.0, size_y_m = 0.0, offset_m = 0.0;
  std::size_t sample = 0;      ///< particles with exact forces, drawn evenly from the patch
  std::size_t edge_sample = 0; ///< further ones near the edges
  double edge_width_m = 0.0;   ///< largest distance of these from an edge
  double preparation_s = 0.0;  ///< wall time to make or read the state
};

/// Makes the patch and measures each setting. Precondition: count and repeats are positive.
/// Throws what make_gravity_solver() throws.
GravityBench bench_gravity(const GravityBenchSettings& settings);

/// Measures these choices in the given patch. Precondition: the patch has particles, and `repeats` > 0.
GravityBench bench_gravity_of(const Patch& state, const std::vector<GravityChoice>& choices, int repeats,
                              PhaseProgress& progress);

} // namespace keeler::bench
