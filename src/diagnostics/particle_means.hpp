// Means over all particles of a run, from their elements in memory order: no copy, no sorting, and exact sums, so that
// they do not depend on memory order or ranks. Equal to the means of a patch (diagnostics/dispersion.hpp) up to
// rounding.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/hill/elements.hpp>
#include <keeler/particles/store.hpp>

namespace keeler::diagnostics {

/// Means of the spins of rough particles; all 0 for smooth ones.
struct SpinMeans {
  double energy = 0.0;        ///< Σ ½ I (ω − Ω)², in Hill's frame, kg m² rad⁻²
  double random_energy = 0.0; ///< Σ ½ I (ω − ⟨ω⟩)², kg m² rad⁻²
  Vec3 mean = Vec3::Zero();   ///< ⟨ω⟩ relative to the stars, rad⁻¹
  double dispersion = 0.0;    ///< √⟨|ω − ⟨ω⟩|²⟩, rad⁻¹
};

/// Weighted by mass. The bits depend on the particles only.
struct ParticleMeans {
  double mass = 0.0;              ///< Σ m, kg
  double epicyclic_energy = 0.0;  ///< Σ m (½κ²e² + ½ν²i²), kg m² rad⁻²
  double azimuthal = 0.0;         ///< Σ m c_y², c_y = ẏ + S x, kg m² rad⁻²
  Vec3 dispersion = Vec3::Zero(); ///< velocity_dispersion(), m rad⁻¹
  double random_stress = 0.0; ///< ⟨c_x c_y⟩ without the mean motion, m² rad⁻²: S × translational_viscosity()
  double scale_height = 0.0;  ///< scale_height(), m
  SpinMeans spin;
  Vec3 motion = Vec3::Zero(); ///< ⟨c⟩, the mean motion beyond the shear, m rad⁻¹
};

/// Returns means at `after` (rad) from the epoch of the elements; all are 0 without particles. Collective: over the
/// particles of all ranks.
ParticleMeans particle_means(const Particles& particles, const Frequencies& frequencies, double after,
                             const Communicator& ranks = {});

} // namespace keeler::diagnostics
