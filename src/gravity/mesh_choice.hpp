// The sizes of the mesh's cells and tiles: functions of the box, the number of particles and their heights alone.
#pragma once

#include "mesh.hpp"
#include "sorted_particles.hpp"

#include <keeler/core/vector.hpp>

#include <span>

namespace keeler::gravity {

/// Distance of planes in spacings. The vertical attraction of a thin layer is coherent: errors along z matter most.
inline constexpr double plane_spacing_ratio = 0.5;

/// Heights of the lowest and the highest particle, m. Without particles low is +∞ and high −∞.
struct Extent {
  double low, high;
};

/// Returns the heights of particles. Throws InvariantError if a position is not finite.
Extent extent_of(std::span<const Vec3> positions);

/// Throws InvariantError if a particle is too far from the mid-plane for a mesh over all heights.
void require_layer(const ShearingBox& box, const Extent& z);

/// Returns the number of nodes of a mesh with that spacing over the box and these heights, without an upper bound.
double mesh_nodes(const ShearingBox& box, double spacing, const Extent& z);

/// Returns the number of nodes that `count` particles may have at most.
double max_mesh_nodes(std::size_t count);

/// Returns the spacing, increased if the mesh would have too many nodes per particle: few particles in a large box, or
/// some far from the layer. Clouds scale with the spacing, so the error stays equal, and neighbours cost more.
double affordable_spacing(const ShearingBox& box, double spacing, const Extent& z, std::size_t count);

/// Returns tiles of about 8 particles: few enough to be close together, enough to share the search for neighbours.
Tiling tiling_for(const MeshShape& shape, std::size_t count);

} // namespace keeler::gravity
