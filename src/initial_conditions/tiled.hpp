// A patch repeated into a larger one: a settled state fills a box in which it would take too long to grow.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstddef>

namespace keeler::initial_conditions {

/// Returns nx × ny copies of a patch, one particle for each image: the same ring at the same instant, so all distances,
/// accelerations and relative velocities are unchanged to rounding. The box grows in proportion; its shear
/// offset is nx times the patch's, and its time is zero. A single copy is bit-identical to the patch.
///
/// Copies are counted column by column, outward, and within a column forward along the orbit. Copy c of the particle
/// with the id i has the id i + c × (1 + the patch's largest id).
///
/// Guiding centres are in the new cell, or as little outside as in the patch. Throws UsageError if the new box or its
/// number of particles exceeds the limits of a run. Precondition: ids in ascending order.
Patch tiled_patch(const Patch& patch, std::size_t nx, std::size_t ny);

/// Such a patch in pieces, for patches larger than memory. Refers to the small patch.
class TiledPatch {
public:
  TiledPatch(const Patch& patch, std::size_t nx, std::size_t ny);

  std::size_t size() const { return nx_ * ny_ * patch_.size(); }
  bool rough() const { return !patch_.spins.empty(); }
  /// Returns particles [first, first + count), in the order of their ids.
  Patch some(std::size_t first, std::size_t count) const;

private:
  const Patch& patch_;
  std::size_t nx_, ny_;
};

} // namespace keeler::initial_conditions
