// Box-long axisymmetric epicyclic waves: the mean eccentricity vector as a function of the guiding radius X, in its
// longest modes, k_n = 2πn/L_x. Such waves grow in dense rings by viscous overstability (Schmit & Tscharnuter 1995,
// Icarus 115, 304; Salo, Schmidt & Spahn 2001, Icarus 153, 295; Latter & Ogilvie 2009, Icarus 202, 565). They are
// collective, not random motion, and their amplitude depends on the age of a run and on its box.
//
// As a function of X, not of x, a wave is linear at any amplitude: X stays constant while the eccentricity vector
// rotates.
#pragma once

#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/particles/patch.hpp>

#include <optional>

namespace keeler::diagnostics {

/// Modes 1 … box_long_modes count as box-long.
inline constexpr int box_long_modes = 4;

/// Fractions of mean squares about the mean motion in the waves, minus the expected values for random particles.
/// Without waves each scatters about 0.
struct EpicyclicWaves {
  double energy = 0.0;     ///< of the epicyclic energy in the plane, ⟨½κ²e²⟩
  double x = 0.0, y = 0.0; ///< of c_x² and of c_y²

  /// Returns the velocity dispersion about the velocity field of the waves, which have no vertical part.
  Vec3 residual_dispersion(const Vec3& dispersion) const;
};

/// Returns nothing if random particles would have half of their motion in these modes, or if nothing moves.
std::optional<EpicyclicWaves> epicyclic_waves(const Patch& patch);

/// As above, for the particles of all ranks at `after` (rad) from their epoch, from sums in 256 bins of the guiding
/// radius, with an error below 0.06/√N. The bits depend on the particles only. Collective. Precondition: `means` of
/// the particles at that time.
std::optional<EpicyclicWaves> epicyclic_waves(const Particles& particles, double box_length,
                                              const Frequencies& frequencies, double after, const ParticleMeans& means,
                                              const Communicator& ranks = {});

} // namespace keeler::diagnostics
