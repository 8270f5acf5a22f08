// Gravity as the exact sum over all pairs and images: the reference, and the best choice for a few hundred particles.
#pragma once

#include <keeler/gravity/images.hpp>
#include <keeler/gravity/kernels.hpp>
#include <keeler/gravity/solver.hpp>

namespace keeler {

class DirectSolver final : public GravitySolver {
public:
  DirectSolver(const ImageSettings& images, InstructionSet set);

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;
  std::string name() const override { return "direct"; }

private:
  ImageSettings images_;
  InstructionSet set_;
};

/// Accelerations (m rad^-2) of some of the particles by that sum in double precision: what other solvers' errors are
/// measured against. With all images and three rings the error is below 1e-6 G Σ.
std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set);

} // namespace keeler
