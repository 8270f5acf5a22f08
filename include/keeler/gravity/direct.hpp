// Gravity as the exact sum over all pairs and images (and the sheet beyond them): the reference, and the best choice
// for a few hundred particles.
#pragma once

#include <keeler/gravity/kernels.hpp>
#include <keeler/gravity/solver.hpp>

#include <vector>

namespace keeler {

/// Of the sums over pairs. Single precision (with sums in doubles) is good to some 3e-7 and twice as fast.
enum class Precision { double_precision, single_precision };

class DirectSolver final : public GravitySolver {
public:
  DirectSolver(int image_rings, InstructionSet set, Precision precision = Precision::double_precision);

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;
  std::string name() const override { return "direct"; }

private:
  int image_rings_;
  AttractionKernels kernels_;
  Precision precision_;
};

} // namespace keeler
