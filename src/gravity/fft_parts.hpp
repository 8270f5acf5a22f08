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

#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/fft.hpp>

#include <complex>
#include <span>
#include <vector>

namespace keeler {

struct NearSums {
  ExactSum potential, stress;

  NearSums& operator+=(const NearSums& more) {
    potential += more.potential;
    stress += more.stress;
    return *this;
  }
};

struct FftSolver::Parts {
  Parts(const FftSettings& chosen, InstructionSet set);

  /// Sets the radius and the particles' force on themselves as well. The heights and the number are those of all.
  MeshShape choose_mesh(const ShearingBox& box, const Extent& z, std::size_t count);

  void spread(const GravityProblem& problem, double offset);
  void fill_mesh(const GravityProblem& problem, double offset);
  /// ½ Σ m_i m_j of the clouds' potential at the other particles, wave by wave, in units of mass: a particle's
  /// potential in its own cloud is taken out. Collective.
  double mesh_potential(const GravityProblem& problem, double offset);
  /// Of the mesh that mesh_potential() had. Collective.
  NearForces::Energy near_energy(const GravityProblem& problem, double offset);
  /// What a wave adds to mesh_potential(), of the mesh's waves and the potential's.
  double wave_potential(std::size_t m, const std::complex<float>* from, const std::complex<float>* to) const;
  /// Σ m² of some places that follow each other.
  ExactSum squared_masses(std::size_t begin, std::size_t end) const;
  /// Over some tiles that follow each other.
  NearSums near_sums(const ShearingBox& box, double offset, std::size_t first_tile, std::size_t tiles);

  /// Returns Σ m a over the tile, in units of mass. The accelerations have the indices of the places.
  Vec3 accelerate_tile(const GravityProblem& problem, double offset, std::size_t tile, std::span<Vec3> accelerations);

  /// One rank's part in a solve of many (fft_ranks.cpp).
  void accelerate_share(const GravityProblem& problem, std::span<Vec3> accelerations);
  double fraction_of_potential(const GravityProblem& problem, double offset);
  NearForces::Energy fraction_of_near_energy(const GravityProblem& problem, double offset);
  struct Known;
  Known know(const GravityProblem& problem, double offset, bool with_neighbours);
  void turn_to_waves(const Communicator& ranks, const Known& known);
  std::vector<Blocks> columns_of_share(const Known& known);
  std::vector<Blocks> waves_of_share(const Known& known);
  void fill_share(const Communicator& ranks, const Known& known);

  FftSettings settings;
  MeshKernels kernels;
  ForceSplit split;
  WaveKernel waves;
  NearForces near;
  Places places;
  Mesh mesh;
  ShearedTransform transform;
  // of a rank's share
  HalfSpectrum by_columns, by_waves;
  std::vector<InsideParticle> inside; // kept for its memory
  double radius = 0.0;                // of the clouds in this solve, m
  SelfForce self{};
};

} // namespace keeler
