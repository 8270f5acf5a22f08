// Means over all particles of a run, from their elements as they lie in memory: no copy, no sorting, one pass on all
// threads. The same numbers as those of a patch (diagnostics/dispersion.hpp), up to rounding.
#pragma once

#include <keeler/orbit/elements.hpp>
#include <keeler/particles/store.hpp>

namespace keeler {

/// Weighted by mass. The bits follow from the particles and their order in memory, not from the threads.
struct ParticleMeans {
  double mass = 0.0;              ///< Σ m, kg
  double energy = 0.0;            ///< Σ m × epicyclic energy per mass, kg m² rad⁻²: total_energy()
  Vec3 dispersion = Vec3::Zero(); ///< velocity_dispersion(), m rad⁻¹
  double scale_height = 0.0;      ///< scale_height(), m
};

/// At `after` (rad) from the epoch of the elements. All are 0 without particles.
ParticleMeans particle_means(const Particles& particles, const Frequencies& frequencies, double after);

} // namespace keeler
