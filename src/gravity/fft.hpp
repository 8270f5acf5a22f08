// Gravity by a mesh and neighbours (P³M; Hockney & Eastwood, Computer Simulation Using Particles): truly shear-periodic
// in x and y, open in z.
//
// Each particle's attraction is split into that of a smooth spherical cloud, computed on a mesh by Fourier transforms,
// and the rest, which vanishes exactly outside the cloud and is summed over neighbours. The mesh stays rectangular at
// any shear offset. Planetary rings suit the method: hard spheres limit the density, and so the number of neighbours.
#pragma once

#include <keeler/core/simd.hpp>
#include <keeler/gravity/solver.hpp>

#include <memory>
#include <span>

namespace keeler::gravity {

struct FftSettings {
  double spacing = 0.0;    ///< of the mesh, m; the mesh may be slightly finer, or coarser for few particles
  double cut = 2.5;        ///< radius of the cloud, which is the cut-off of the neighbour sum, in spacings; at least 1
  bool short_range = true; ///< false: the smooth part alone, for mean fields
};

/// The cheapest spacing of the mesh, in mean particle distances, (number per area)^−1/2.
inline constexpr double cheapest_spacing = 1.6;

struct MeshSize {
  double nodes, cells; ///< in all planes; of one
};

/// Returns the size of the mesh for `count` particles in a layer of total height `height` (m). For estimates; `spacing`
/// is that of FftSettings.
MeshSize mesh_size(const ShearingBox& box, double spacing, double height, std::size_t count);

/// Returns the bytes of the mesh, whose memory its waves have too, and their phases, without the memory per particle
/// and thread, at most: if the mesh has too many nodes (affordable_spacing()), particles at other heights may leave any
/// number of nodes up to the bound. Ranks have some or all of their waves beside it.
double max_mesh_bytes(const ShearingBox& box, double spacing, double height, std::size_t count);

/// Returns √⟨m²⟩ / ⟨m⟩ over all ranks: 1 for equal masses. The bits do not depend on the order. Collective.
double mass_spread(std::span<const double> masses, const Communicator& ranks = {});

/// Returns the cut, from 2 to 16, for a required rms error of the force over its rms, at the cheapest spacing. Errors
/// down to 1e-4 were kept in every patch measured (docs/dev/gravity-fft.md). Precondition: both arguments are positive.
double cut_for(double force_error, double mass_spread);

class FftSolver final : public GravitySolver, public EnergyMeter {
public:
  FftSolver(const FftSettings& settings, InstructionSet set);
  ~FftSolver() override;

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;

  /// Returns energy and stress of the same mesh and neighbours. Collective.
  GravityEnergy energy(const GravityProblem& problem) override;

  std::string name() const override; ///< "fft", or "mesh" without the short range

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace keeler::gravity
