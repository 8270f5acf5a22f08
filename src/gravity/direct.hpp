// Gravity as the exact sum over all pairs and images: the reference for all solvers.
#pragma once

#include <keeler/core/simd.hpp>
#include <keeler/gravity/solver.hpp>

namespace keeler::gravity {

/// Precision of the sums over pairs. Single (with sums in doubles) is accurate to some 3e-7 and twice as fast.
enum class Precision { double_precision, single_precision };

class DirectSolver final : public GravitySolver {
public:
  DirectSolver(const ImageSettings& images, InstructionSet set, Precision precision = Precision::double_precision);

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;
  std::string name() const override { return "direct"; }

private:
  ImageSettings images_;
  InstructionSet set_;
  Precision precision_;
};

/// Returns the accelerations (m rad^-2) of the particles with the indices `sample`, by the direct sum: the reference
/// for errors of other solvers. With all images and three rings the error is below 1e-6 G Σ.
std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set,
                                        Precision precision = Precision::double_precision);

} // namespace keeler::gravity
