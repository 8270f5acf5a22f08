// Gravity as the exact sum over all pairs and images (and the sheet beyond them): the reference, and the best choice
// for a few hundred particles.
#pragma once

#include <keeler/gravity/kernels.hpp>
#include <keeler/gravity/solver.hpp>

namespace keeler {

class DirectSolver final : public GravitySolver {
public:
  DirectSolver(int image_rings, InstructionSet set);

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;
  std::string name() const override { return "direct"; }

private:
  int image_rings_;
  AttractionKernels kernels_;
};

} // namespace keeler
