// Radial self-gravity alone: the pull of the surface density averaged along the orbit, as a thin sheet in the
// mid-plane. It is what simulations of viscous overstability use (Salo & Schmidt 2010; Lehmann, Schmidt & Salo 2017),
// whose waves are axisymmetric: no wakes form, and the layer's own vertical pull is put into ν (planet.vertical_ratio).
//
//   Σ(x) = ⟨Σ⟩ + Σ_n (S_n exp(i k_n x) + c.c.)     k_n = 2π n / L_x, n = 1 … L_x / shortest_wavelength
//   Φ(x) = −2π G Σ_n (S_n / k_n) exp(i k_n x) + c.c.     g_x = −dΦ/dx
//
// Shorter waves are the noise of single particles and must be cut off: a particle is no line along the orbit.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <memory>
#include <string>

namespace keeler {

/// What the mesh of the radial waves is for a box of that width (m), before there is one: its nodes, a whole number
/// that grows as size_x / shortest_wavelength without a bound, and its bytes on that many threads.
double radial_mesh_nodes(double size_x, double shortest_wavelength);
double radial_mesh_bytes(double size_x, double shortest_wavelength, int threads);

/// "gravity.shortest_wavelength = 1e-18 m is too short (why); raise it", where no mesh over a box of that width has
/// such waves; empty where one has.
std::string radial_mesh_fault(double size_x, double shortest_wavelength);

class AxisymmetricSolver final : public GravitySolver, public EnergyMeter {
public:
  /// `shortest_wavelength` in m. Solving throws UsageError with radial_mesh_fault(), or where
  /// there is no memory for the mesh.
  explicit AxisymmetricSolver(double shortest_wavelength);
  ~AxisymmetricSolver() override;

  /// The exact sum over the waves to 1e-8 of the largest. Momentum is kept, and no particle pulls itself.
  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;

  /// Φ of the waves, that of each particle with itself included, which is constant. No torque: the stress is 0.
  GravityEnergy energy(const GravityProblem& problem) override;

  std::string name() const override { return "axisymmetric"; }

private:
  struct Mesh;
  std::unique_ptr<Mesh> mesh_;
};

} // namespace keeler
