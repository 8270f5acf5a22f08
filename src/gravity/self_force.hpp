// The self-force of the mesh: it pulls each particle towards or away from the middle of its cell, because its weights
// in the nodes return through an interpolation that varies over the cell. In a ring this is the largest error of a mesh
// with analytic gradients. It depends on the particle's position in its cell alone and is subtracted (for charges:
// Ballenegger, Cerdà & Holm 2011, Comput. Phys. Commun. 182, 1919).
//
// Along each axis it is s₁ sin 2πt + s₂ sin 4πt, t the position in the cell; the dependence on the other two
// coordinates and the higher harmonics are 2 % of it. It is that of an infinite mesh: particles in the last columns
// keep part of theirs, since their weights in ghosts go to rows at other phases.
#pragma once

#include "force_split.hpp"
#include "mesh.hpp"

namespace keeler::gravity {

/// Returns the self-force of a particle of mass 1 at G = 1, m^-2, for clouds of that radius (m).
SelfForce self_force(const MeshShape& shape, const ForceSplit& split, double radius);

} // namespace keeler::gravity
