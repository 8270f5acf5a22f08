// How wrong a solver's accelerations are, measured on some of the particles, as a share of the rms acceleration.
//
// Some are drawn evenly: they give the errors of the whole. Others stand beside each of the cell's four edges: a force
// that is not truly periodic pulls these to one side.
#pragma once

#include <keeler/gravity/solver.hpp>
#include <keeler/particles/patch.hpp>

#include <array>
#include <span>
#include <vector>

namespace keeler {

/// What a solver sees of a patch, which must outlive it.
GravityProblem gravity_problem(const Patch& patch);

/// Who is looked at: indices into a problem, each group in the order drawn.
struct ForceSample {
  std::vector<std::size_t> targets;   ///< those drawn evenly, then those of the edges x < 0, x > 0, y < 0, y > 0
  std::size_t even = 0;               ///< how many were drawn evenly
  std::array<std::size_t, 4> edges{}; ///< how many stand at each edge; the same particle may stand at two
};

/// Draws at random, always the same ids of the same particles, in whatever order these are: `even` of all particles,
/// and `at_each_edge` of those within `edge_width` (m) of an edge, or as many as there are.
ForceSample draw_force_sample(const GravityProblem& problem, std::size_t even, std::size_t at_each_edge,
                              double edge_width);

/// Errors over the rms |a| of the particles drawn evenly; 0 where nobody was drawn.
struct ForceErrors {
  double rms = 0.0;                      ///< of |δa|
  double p999 = 0.0;                     ///< 99.9 % have a smaller |δa|: the largest of fewer than 1000
  std::array<double, 3> component_rms{}; ///< of δa_x, δa_y, δa_z
  double edge_rms = 0.0;                 ///< of |δa| beside the edges
  double edge_pull =
      0.0; ///< |mean of δa along the plane| beside the worst edge, over the rms acceleration in the plane
};

/// `exact` has the true accelerations of the sample's targets, in their order; `accelerations` those of all particles.
ForceErrors force_errors(const ForceSample& sample, std::span<const Vec3> exact, std::span<const Vec3> accelerations);

/// |Σ m a| / Σ m |a|.
double net_force(std::span<const double> masses, std::span<const Vec3> accelerations);

} // namespace keeler
