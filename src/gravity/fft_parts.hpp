// The mesh solver's data, and the steps of a solve that are common to one process and many ranks.
#pragma once

#include "force_split.hpp"
#include "mesh.hpp"
#include "mesh_choice.hpp"
#include "near_forces.hpp"
#include "self_force.hpp"
#include "sheared_transform.hpp"
#include "sorted_particles.hpp"
#include "wave_kernel.hpp"

#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/fft.hpp>

#include <complex>
#include <span>
#include <vector>

namespace keeler::gravity {

/// Exact sums of NearForces::Energy.
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

  /// Chooses the mesh for `count` particles between the heights z, and sets the radius and the self-force.
  MeshShape choose_mesh(const ShearingBox& box, const Extent& z, std::size_t count);

  /// Sorts the particles and spreads their masses on the mesh.
  void spread(const GravityProblem& problem, double offset);
  /// As spread(), then turns the masses into the potential on the mesh.
  void fill_mesh(const GravityProblem& problem, double offset);
  /// Returns ½ Σ m_i m_j of the clouds' potential at the other particles, in units of mass: each particle's potential
  /// in its own cloud is subtracted. Collective.
  double mesh_potential(const GravityProblem& problem, double offset);
  /// Returns what neighbours contribute. Precondition: mesh_potential() chose the mesh. Collective.
  NearForces::Energy near_energy(const GravityProblem& problem, double offset);
  /// Returns the contribution of wave m to mesh_potential(), from its masses and its potential on the planes.
  double wave_potential(std::size_t m, const std::complex<float>* masses, const std::complex<float>* potential) const;
  /// Returns Σ m² over sorted particles [begin, end).
  ExactSum squared_masses(std::size_t begin, std::size_t end) const;
  /// Returns the sum over tiles [first_tile, first_tile + tiles).
  NearSums near_sums(const ShearingBox& box, double offset, std::size_t first_tile, std::size_t tiles);

  /// Releases what only a solve in progress needs. The memory of a run is for one thing after another.
  void release() {
    sorted.release();
    mesh.release_memory();
  }

  /// Writes the accelerations of a tile's particles at their indices, and returns Σ m a over the tile in units of mass.
  Vec3 accelerate_tile(const GravityProblem& problem, double offset, std::size_t tile, std::span<Vec3> accelerations);

  // the part of one rank in a solve of many (fft_distributed.cpp); all are collective
  void accelerate_distributed(const GravityProblem& problem, std::span<Vec3> accelerations);
  double mesh_potential_distributed(const GravityProblem& problem, double offset);
  NearForces::Energy near_energy_distributed(const GravityProblem& problem, double offset);
  struct DistributedSolve;
  DistributedSolve begin_distributed(const GravityProblem& problem, double offset, bool with_neighbours);
  HalfSpectrum spread_distributed(const DistributedSolve& solve);
  void fill_mesh_distributed(const Communicator& ranks, const DistributedSolve& solve);

  FftSettings settings;
  MeshKernels kernels;
  ForceSplit split;
  WaveKernel waves;
  NearForces near;
  SortedParticles sorted;
  Mesh mesh;
  ShearedTransform transform;
  // of the solve in progress
  double radius = 0.0; // of the clouds, m
  SelfForce self{};
};

} // namespace keeler::gravity
