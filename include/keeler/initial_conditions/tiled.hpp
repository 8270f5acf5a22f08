// A patch repeated into a larger one: a state that took long to settle fills a box in which it could not have been
// grown.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstddef>

namespace keeler {

/// nx times ny copies of a patch, a particle each for its images: the same ring at the same instant, so that all
/// distances, accelerations and relative velocities are those of the patch to rounding. The box is as many times as
/// large; its shear offset is nx times the patch's, and its time is zero. One copy has the bits of the patch.
///
/// Copies are counted column by column, outward, and in a column forward along the orbit. Copy c of the particle with
/// the id i has the id i + c × (1 + the patch's largest id).
///
/// Guiding centres lie in the new cell, or as little outside as they do in the patch. Throws UsageError where the new
/// box or its number of particles would be more than a run takes.
Patch tiled_patch(const Patch& patch, std::size_t nx, std::size_t ny);

/// The same, some particles at a time: of a patch that no memory need hold. It refers to the small one.
class TiledPatch {
public:
  TiledPatch(const Patch& patch, std::size_t nx, std::size_t ny);

  std::size_t size() const { return nx_ * ny_ * patch_.size(); }
  bool rough() const { return !patch_.spins.empty(); }
  /// Those from the first one on, in the order of their ids.
  Patch some(std::size_t first, std::size_t count) const;

private:
  const Patch& patch_;
  std::size_t nx_, ny_;
};

} // namespace keeler
