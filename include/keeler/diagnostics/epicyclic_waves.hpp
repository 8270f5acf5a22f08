// Axisymmetric epicyclic waves as long as the box: the mean eccentricity vector as a function of the guiding radius X,
// in its longest modes, k_n = 2πn/L_x. Such waves grow in dense rings by viscous overstability (Schmit & Tscharnuter
// 1995, Icarus 115, 304; Salo, Schmidt & Spahn 2001, Icarus 153, 295; Latter & Ogilvie 2009, Icarus 202, 565). They are
// common motion, not random motion, and how far they have grown depends on the age of a run and on its box.
//
// Over X, and not over x, a wave is linear at any amplitude: a particle keeps its X while its eccentricity vector
// turns.
#pragma once

#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/particles/patch.hpp>

#include <optional>

namespace keeler {

/// Modes 1 … box_long_modes count as long as the box.
inline constexpr int box_long_modes = 4;

/// Fractions of mean squares about the mean motion that the waves hold, without the part that particles at random would
/// show. Without waves each scatters about 0.
struct EpicyclicWaves {
  double energy = 0.0;     ///< of the epicyclic energy in the plane, ⟨½κ²e²⟩
  double x = 0.0, y = 0.0; ///< of c_x² and of c_y²

  /// Returns the velocity dispersion about the velocity field of the waves; they have no part in the vertical one.
  Vec3 taken_out_of(const Vec3& dispersion) const;
};

/// None where particles at random would show half of their motion in these modes, and where nothing moves.
std::optional<EpicyclicWaves> epicyclic_waves(const Patch& patch);

/// Returns the same of the particles of all ranks at `after` (rad) from their epoch, from sums in 256 bins of the
/// guiding radius, which errs by less than 0.06/√N. `means` are those of the particles at that time. The bits follow
/// from the particles alone. Collective.
std::optional<EpicyclicWaves> epicyclic_waves(const Particles& particles, double box_length,
                                              const Frequencies& frequencies, double after, const ParticleMeans& means,
                                              const Communicator& ranks = {});

} // namespace keeler
