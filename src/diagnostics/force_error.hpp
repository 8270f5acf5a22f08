// The error of a solver's accelerations on a sample of the particles, relative to the rms acceleration.
//
// Some particles are drawn uniformly: their errors represent the whole. Others are next to each of the cell's four
// edges: a force that is not exactly periodic pulls these to one side.
#pragma once

#include <keeler/gravity/solver.hpp>
#include <keeler/particles/patch.hpp>

#include <array>
#include <span>
#include <vector>

namespace keeler::diagnostics {

/// Returns a solver's input for a patch, which must outlive it.
gravity::GravityProblem gravity_problem(const Patch& patch);

/// The sample: indices into a problem, each group in the order drawn.
struct ForceSample {
  std::vector<std::size_t> targets;   ///< the uniform sample, then the edges x < 0, x > 0, y < 0, y > 0
  std::size_t uniform = 0;            ///< number drawn uniformly
  std::array<std::size_t, 4> edges{}; ///< number at each edge; a particle may be at two
};

/// Draws `uniform` of all particles and `at_each_edge` of the particles within `edge_width` (m) of an edge, or all if
/// there are fewer. Always draws the same ids, in any order of the particles.
ForceSample draw_force_sample(const gravity::GravityProblem& problem, std::size_t uniform, std::size_t at_each_edge,
                              double edge_width);

/// Returns the places, in the order of the ids of `count` particles, of the uniform sample that draw_force_sample()
/// draws.
std::vector<std::size_t> draw_force_places(std::size_t count, std::size_t uniform);

/// Errors relative to the rms |a| of the uniform sample; 0 if that is empty.
struct ForceErrors {
  double rms = 0.0;                      ///< of |δa|
  double p999 = 0.0;                     ///< 99.9 % have a smaller |δa|; the largest of fewer than 1000
  std::array<double, 3> component_rms{}; ///< of δa_x, δa_y, δa_z
  double edge_rms = 0.0;                 ///< of |δa| at the edges
  double edge_pull = 0.0; ///< |mean of δa in the plane| at the worst edge, over the rms acceleration in the plane
};

/// `exact`: the true accelerations of the targets, in their order; `accelerations`: of all particles.
ForceErrors force_errors(const ForceSample& sample, std::span<const Vec3> exact, std::span<const Vec3> accelerations);

/// Returns |Σ m a| / Σ m |a|.
double net_force(std::span<const double> masses, std::span<const Vec3> accelerations);

} // namespace keeler::diagnostics
