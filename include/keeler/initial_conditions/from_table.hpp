// A start of a user's own particles.
#pragma once

#include <keeler/io/particle_table.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <cstddef>

namespace keeler {

/// The particles of a table in the scene's box, with the shear offset zero. Particle k of the table gets the id k;
/// masses that the table does not have follow from the scene's density, velocities are those of circular orbits. Throws
/// UsageError, naming the row, for a particle that no ring has, one farther outside the box than an eccentric one is,
/// or without a mass, and for spins where the scene has no friction; InvariantError for particles in heaps.
Patch patch_from_table(const ParticleTable& table, const TableScene& scene);

/// What relax() did.
struct Relaxation {
  std::size_t moved = 0; ///< particles
  double farthest = 0.0; ///< m
};

/// Moves particles that overlap apart, and no others by more than they make room, by the separation of fresh starts
/// (docs/dev/starts.md); each keeps its velocity beyond the shear. Throws InvariantError where there is no room.
Relaxation relax(Patch& patch);

} // namespace keeler
