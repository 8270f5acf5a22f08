// The sums over pairs that a run's forces are compared with: exact enough for the errors of its solver, and no dearer.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::runs {

/// Returns the relative rms error that a solver's settings imply; 0 for the mesh alone and for radial waves, which do
/// not approximate the sum over pairs.
double force_tolerance(const gravity::GravitySettings& settings);

/// Returns whether the solver sums over pairs and near images one by one: the direct sum and the tree do.
bool sums_over_pairs(const gravity::GravitySettings& settings);

/// Returns the near images that a reference for a solver sums one by one; the field of all others is fitted. One ring
/// errs by 3e-5 (docs/theory/gravity.md). Solvers that sum over pairs have two, so that their truncation is tested too.
gravity::ImageSettings reference_images(const gravity::GravitySettings& settings);

/// Accelerations of a sample, in its order, m rad⁻².
struct ComparedForces {
  std::vector<std::uint64_t> ids;
  std::vector<Vec3>
      exact; ///< the reference's; sums are in single precision (3e-7) unless the solver is nearly as exact
  std::vector<Vec3> found; ///< by the solver
};

/// Compares the accelerations of the particles at these places (from 0) in the order of the ids of all ranks.
/// Collective: all ranks give the same places, and get the same result.
ComparedForces compare_forces(const gravity::GravityProblem& problem, std::span<const Vec3> accelerations,
                              std::span<const std::size_t> places, const gravity::GravitySettings& settings,
                              const gravity::ImageSettings& images);

} // namespace keeler::runs
