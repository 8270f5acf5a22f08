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

} // namespace keeler
