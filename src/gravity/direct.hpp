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
  void accelerate_distributed(const GravityProblem& problem, std::span<Vec3> accelerations);

  ImageSettings images_;
  InstructionSet set_;
  Precision precision_;
};

/// Returns the accelerations (m rad^-2) of the particles with the indices `sample`, by the direct sum: the reference
/// for errors of other solvers. With all images and three rings the error is below 1e-6 G Σ.
std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set,
                                        Precision precision = Precision::double_precision);

/// Returns likewise the accelerations of particles by id, on all ranks, with the bits of one process. Collective: all
/// ranks give the same ids. No rank gets all particles: 40 bytes of each are sorted by id over the ranks, and the sums
/// go from rank to rank. Precondition: several ranks have the problem's particles.
std::vector<Vec3> sampled_accelerations_of_ranks(const GravityProblem& problem, std::span<const std::uint64_t> sample,
                                                 const ImageSettings& images, InstructionSet set, Precision precision);

} // namespace keeler::gravity
