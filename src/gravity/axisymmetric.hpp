// Radial self-gravity alone: the attraction of the surface density averaged along the orbit, as a thin sheet in the
// mid-plane. Simulations of viscous overstability use it (Salo & Schmidt 2010; Lehmann, Schmidt & Salo 2017): its
// waves are axisymmetric, no wakes form, and ν contains the layer's vertical self-gravity (planet.vertical_ratio).
//
//   Σ(x) = ⟨Σ⟩ + Σ_n (S_n exp(i k_n x) + c.c.)     k_n = 2π n / L_x, n = 1 … L_x / shortest_wavelength
//   Φ(x) = −2π G Σ_n (S_n / k_n) exp(i k_n x) + c.c.     g_x = −dΦ/dx
//
// Shorter waves are the noise of single particles and must be cut off, since a particle is not a line along the orbit.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <memory>
#include <string>

namespace keeler::gravity {

/// Return the number of nodes of the mesh for a box of this width (m), a whole number without an upper bound, and the
/// mesh's bytes on `threads` threads. Both can be called before a solver exists.
double radial_mesh_nodes(double size_x, double shortest_wavelength);
double radial_mesh_bytes(double size_x, double shortest_wavelength, int threads);

/// Returns the error, e.g. "gravity.shortest_wavelength = 1e-18 m is too short (why); raise it", if no mesh over a box
/// of this width (m) has such waves; otherwise an empty string.
std::string radial_mesh_fault(double size_x, double shortest_wavelength);

class AxisymmetricSolver final : public GravitySolver, public EnergyMeter {
public:
  /// `shortest_wavelength` in m, positive. Solving throws UsageError with radial_mesh_fault(), or if there is not
  /// enough memory for the mesh.
  explicit AxisymmetricSolver(double shortest_wavelength);
  ~AxisymmetricSolver() override;

  /// Writes the sum over the waves, to 1e-8 of the largest wave. Momentum is conserved; particles have no self-force.
  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;

  /// Returns Φ of the waves; it includes each particle's self-energy, a constant. There is no torque: the stress is 0.
  GravityEnergy energy(const GravityProblem& problem) override;

  std::string name() const override { return "axisymmetric"; }

private:
  struct Mesh;
  std::unique_ptr<Mesh> mesh_;
};

} // namespace keeler::gravity
