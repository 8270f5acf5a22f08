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

namespace keeler {

class AxisymmetricSolver final : public GravitySolver, public EnergyMeter {
public:
  /// `shortest_wavelength` in m. Solving throws UsageError where the box is narrower than that.
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
