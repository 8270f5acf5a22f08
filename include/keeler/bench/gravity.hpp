// What a gravity solve costs and how wrong it is, for every solver with every setting: a patch of Saturn's A ring, the
// physics of examples/a-ring-wakes.
#pragma once

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/diagnostics/force_error.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace keeler {

struct GravityBenchSettings {
  std::size_t count = 100000; ///< rounded to whole tiles, and up to what two λ_cr by two hold
  bool clumped = true;        ///< wakes stand; else a fresh, uniform patch
  std::string solver;         ///< empty: all, `direct` only where it takes seconds
  bool dense = false;         ///< more settings of each solver
  int repeats = 5;
  std::function<void(const Progress&)> progress; ///< may be empty
};

/// One solver with one setting. The time is the median over the repeats: processor time on one thread, wall time on
/// several; sorting and tree building included.
struct GravityBenchRow {
  GravityChoice choice;
  ForceErrors errors;     ///< against the sum over all pairs and images, on the sample
  double net_force = 0.0; ///< |Σ m a| / Σ m |a|, of all particles
  double ns_per_particle = 0.0;

  /// All of these under the names that JSON and CSV have.
  std::vector<std::pair<std::string, double>> numbers() const;
};

struct GravityBench {
  std::vector<GravityBenchRow> rows;
  std::size_t count = 0; ///< particles there are
  double size_x_m = 0.0, size_y_m = 0.0, offset_m = 0.0;
  std::size_t sample = 0;      ///< particles drawn evenly, whose force was worked out exactly
  std::size_t edge_sample = 0; ///< and those beside the edges
  double edge_width_m = 0.0;   ///< how near these stand
};

/// Throws what make_gravity_solver() throws.
GravityBench bench_gravity(const GravityBenchSettings& settings);

/// The same of these choices in any patch.
GravityBench bench_gravity_of(const Patch& state, const std::vector<GravityChoice>& choices, int repeats,
                              PhaseProgress& progress);

} // namespace keeler
