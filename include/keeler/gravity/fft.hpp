// Gravity by a mesh and neighbours (P³M; Hockney & Eastwood, Computer Simulation Using Particles): truly shear-periodic
// in x and y, open in z.
//
// Each particle's attraction is split into that of a smooth round cloud, which a mesh carries and transforms to and
// fro, and the rest, which vanishes outside the cloud exactly and is summed over neighbours. The mesh stays square at
// any shear offset. Rings suit it: hard spheres cap the density, so no particle has very many neighbours.
#pragma once

#include <keeler/core/simd.hpp>
#include <keeler/gravity/solver.hpp>

#include <memory>
#include <span>

namespace keeler {

struct FftSettings {
  double spacing = 0.0;    ///< of the mesh, m; it takes this or a little less (or more, where particles are few)
  double cut = 2.5;        ///< radius of the cloud, beyond which neighbours need no sum, in spacings; at least 1
  bool short_range = true; ///< false: the smooth part alone, for mean fields
};

/// The cheapest spacing of the mesh, in mean distances of particles, (their number an area)^−1/2.
inline constexpr double cheapest_spacing = 1.6;

/// Bytes of the mesh and of its waves for so many particles, which lie within `height` (m) from the lowest to the
/// highest; what is kept a particle is not in it. For estimates: `spacing` is that of FftSettings.
double mesh_bytes(const ShearingBox& box, double spacing, double height, std::size_t count);

/// √⟨m²⟩ / ⟨m⟩: 1 for equal masses. The same bits in any order. Collective: of the masses of all ranks.
double mass_spread(std::span<const double> masses, const Communicator& ranks = {});

/// A cut, from 2 to 16, for a rms error of the force over its rms, with that spacing. It kept errors down to 1e-4 in
/// every patch measured (docs/dev/gravity-fft.md).
double cut_for(double force_error, double mass_spread);

class FftSolver final : public GravitySolver, public EnergyMeter {
public:
  FftSolver(const FftSettings& settings, InstructionSet set);
  ~FftSolver() override;

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;

  /// By the same mesh and neighbours.
  GravityEnergy energy(const GravityProblem& problem) override;

  std::string name() const override; ///< "mesh" without the short range

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace keeler
