// How large the mesh's cells and tiles are: by the box, the number of particles and their heights alone.
#pragma once

#include "mesh.hpp"
#include "places.hpp"

#include <keeler/core/vector.hpp>

#include <span>

namespace keeler {

/// Distance of planes in spacings. The layer is thin and its vertical pull coherent: an error along z shows most.
inline constexpr double flatness = 0.5;

/// Particles between a lowest and a highest one: infinite the other way round where there are none.
struct Extent {
  double low, high;
};

/// Throws InvariantError when a place is not finite.
Extent extent_of(std::span<const Vec3> positions);

/// Throws InvariantError when a particle is so far from the mid-plane that there is no layer to put a mesh over.
void require_layer(const ShearingBox& box, const Extent& z);

/// Nodes of a mesh with that spacing over the box and these heights, as a number that has no bound.
double mesh_nodes(const ShearingBox& box, double spacing, const Extent& z);

/// The spacing, made larger where the mesh would hold very many nodes a particle: few particles in a large box, or some
/// that have strayed far from the layer. Clouds grow with it, so the error stays what it was, and neighbours cost more.
double affordable_spacing(const ShearingBox& box, double spacing, const Extent& z, std::size_t count);

/// About 8 particles a tile: few enough to be close together, and enough to share the search for their neighbours.
Tiling tiling_for(const MeshShape& shape, std::size_t count);

} // namespace keeler
