// A start from a user's table of particles.
#pragma once

#include <keeler/io/particle_table.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/scene.hpp>

#include <cstddef>
#include <string>

namespace keeler::initial_conditions {

/// Returns the particles of a table in the scene's box, with the shear offset that the table states (else zero).
/// Particle k of the table gets the id k. Missing masses follow from the scene's density, missing velocities from
/// circular orbits. Throws UsageError, naming the row, for an invalid particle, one farther outside the box than its
/// epicycle explains, or without a mass, for spins if the scene has no friction, and for a table that states another
/// box or Omega; InvariantError for heaps of overlapping particles.
Patch patch_from_table(const io::ParticleTable& table, const scene::TableScene& scene);

/// Returns what may be wrong with a table whose particles overlap, for messages: "; all are within …, are these in
/// km?", or "; that pair meets across an edge of the box: …" of the largest overlap; empty if neither shows.
std::string overlap_hint(const Patch& patch);

/// Result of relax().
struct Relaxation {
  std::size_t moved = 0; ///< particles
  double farthest = 0.0; ///< m
};

/// Moves overlapping particles apart, and others as far as they must make room, by the separation of fresh starts
/// (docs/dev/starts.md). Each keeps its velocity relative to the shear flow. Throws InvariantError if there is no room.
Relaxation relax(Patch& patch);

} // namespace keeler::initial_conditions
