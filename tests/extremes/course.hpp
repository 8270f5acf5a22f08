// What a run must keep, whatever its state: no sphere sinks in, momentum and energy close to rounding.
#pragma once

#include "rows.hpp"

#include <keeler/simulation/simulation.hpp>

#include "unit/collision/ring.hpp"

#include <complex>
#include <optional>

namespace keeler::extremes {

/// A scene of examples/ with some keys set.
struct Example {
  Scene scene;
  State state; ///< its name, and the command that does the same
};
Example example(const std::string& name, const std::string& scene, const std::vector<std::string>& overrides);

/// Kept sums of a run: without external forces Σ m e and Σ m i (vectors at one epoch) do not change.
struct Course {
  std::uint64_t collisions = 0;
  std::int64_t steps = 0;
  double overlap = 0.0;    ///< the deepest, of a radius sum
  double rounding = 0.0;   ///< of the distance of two centres, over the smallest radius sum
  double momentum = 0.0;   ///< change of the two vector sums, over Σ m (e + i)
  double energy = 0.0;     ///< what the budget leaves open, over Σ m (e² + ν² i²) and what collisions took
  double worst_step = 0.0; ///< contacts of a particle in a step, mean of the worst step
};

/// Follows a run for some steps; overlaps are looked for `looks` times.
Course follow(Simulation& simulation, std::int64_t steps, int looks = 10);
Course follow(const Scene& scene, std::int64_t steps, int looks = 10);

/// The rows that every course gives; `least` contacts are expected at the least.
std::vector<Row> rows_of(const State& state, const Course& course, double least);

/// Steps of a ring beside the plain algorithm, each from the same state.
struct AgainstPlain {
  std::size_t steps = 0, differing = 0, collisions = 0;
  double overlap = 0.0;
  AgainstPlain& operator+=(const AgainstPlain& more);
};
AgainstPlain against_plain(test::Ring& ring, const collision::CollisionSettings& settings, int steps);
std::vector<Row> rows_of(const State& state, const AgainstPlain& course, double rounding, double least);

} // namespace keeler::extremes
