// The mesh solver's parts, and the steps of a solve that one process and one of many ranks take alike.
#pragma once

#include "force_split.hpp"
#include "mesh.hpp"
#include "mesh_choice.hpp"
#include "mesh_shares.hpp"
#include "near_forces.hpp"
#include "places.hpp"
#include "self_force.hpp"
#include "sheared_transform.hpp"
#include "wave_kernel.hpp"

#include <keeler/gravity/fft.hpp>

#include <span>

namespace keeler {

struct FftSolver::Parts {
  Parts(const FftSettings& chosen, InstructionSet set);

  /// Sets the radius and the particles' force on themselves as well. The heights and the number are those of all.
  MeshShape choose_mesh(const ShearingBox& box, const Extent& z, std::size_t count);

  void spread(const GravityProblem& problem, double offset);
  void fill_mesh(const GravityProblem& problem, double offset);
  double mesh_potential(const GravityProblem& problem, double offset);
  NearForces::Energy near_energy(const GravityProblem& problem, double offset);

  /// Returns Σ m a over the tile, in units of mass. The accelerations have the indices of the places.
  Vec3 accelerate_tile(const GravityProblem& problem, double offset, std::size_t tile, std::span<Vec3> accelerations);

  /// One rank's part in a solve of many (fft_ranks.cpp).
  void accelerate_share(const GravityProblem& problem, std::span<Vec3> accelerations);
  void fill_share(const Ranks& ranks, const MeshShape& shape, double offset_part, std::span<const MeshShare> shares);

  FftSettings settings;
  MeshKernels kernels;
  ForceSplit split;
  WaveKernel waves;
  NearForces near;
  Places places;
  Mesh mesh;
  ShearedTransform transform;
  HalfSpectrum by_columns, by_waves; // of a rank's share
  double radius = 0.0;               // of the clouds in this solve, m
  SelfForce self{};
};

} // namespace keeler
