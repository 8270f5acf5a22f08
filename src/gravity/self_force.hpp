// How the mesh makes a particle pull itself: towards or away from the middles of cells, because its own share in the
// nodes comes back through an interpolation that is not the same everywhere in a cell. In a ring this is the largest
// error of a mesh with analytic gradients; it depends on the particle's place in its cell alone and is taken out.
// (Ballenegger, Cerdà & Holm 2011, Comput. Phys. Commun. 182, 1919, do so for charges.)
//
// Along each axis it is s₁ sin 2πt + s₂ sin 4πt, t the place in the cell; what depends on the other two coordinates
// is 2 % of it, and so are higher harmonics. It is that of an endless mesh: particles in the last columns, whose share
// in ghosts goes to rows at other phases, keep part of theirs.
#pragma once

#include "force_split.hpp"
#include "mesh.hpp"

namespace keeler {

/// Of a particle of mass 1 at G = 1, m^-2, for clouds of that radius (m).
SelfForce self_force(const MeshShape& shape, const ForceSplit& split, double radius);

} // namespace keeler
