// Gravity by a tree of cells with quadrupoles (Barnes & Hut 1986, Nature 324, 446), walked once for each group of
// neighbouring particles (Barnes 1990, J. Comput. Phys. 87, 161).
#pragma once

#include "cell_tree.hpp"
#include "kernels.hpp"

#include <keeler/gravity/solver.hpp>

namespace keeler::gravity {

/// A cell attracts a group as a whole if size < opening_angle × (distance from the group's box to the cell's centre of
/// mass) and the two boxes cannot overlap; otherwise it is opened, down to particles. The size is the longest side of
/// the cell's tight box. Distant cells act through the group's local expansion. Opening angle 0 gives the direct sum,
/// in single precision. The net force, an error of the tree, is subtracted.
class TreeSolver final : public GravitySolver {
public:
  TreeSolver(double opening_angle, const ImageSettings& images, InstructionSet set);

  void accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) override;
  std::string name() const override { return "tree"; }

private:
  /// The accelerations of one rank's part of the particles, which follow each other in the tree's order.
  struct Part {
    std::vector<std::size_t> bounds; // of the ranks' parts
    std::vector<Vec3> accelerations;
  };
  /// Solves for this rank's part. Collective over `ranks`, which all give all particles. Precondition: there are some.
  Part solve(const GravityProblem& problem, const Communicator& ranks);
  void accelerate_distributed(const GravityProblem& problem, std::span<Vec3> accelerations);

  double opening_angle_;
  ImageSettings images_;
  InstructionSet set_;
  AttractionKernels kernels_;
  CellTree tree_;
  std::vector<std::uint32_t> indices_; // of in_cell_, in the problem's arrays
  std::vector<PointSource> in_cell_;
};

} // namespace keeler::gravity
