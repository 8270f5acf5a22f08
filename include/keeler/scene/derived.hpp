// Numbers that follow from a scene: what `keeler check` prints, and the formulas that the scene itself is checked with.
// Everything here is SI.
#pragma once

#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <string>

namespace keeler {

/// Mass per unit area of particles of this law at optical depth 1, (4/3) ρ ⟨r³⟩/⟨r²⟩, kg/m².
double surface_density_per_depth(const SizeLaw& sizes, double density);

/// λ_cr, m (orbit/toomre.hpp).
double critical_wavelength(double surface_density, const PlanetSettings& planet);

/// Q for a radial velocity dispersion in m/s (orbit/toomre.hpp).
double toomre_q(double surface_density, double dispersion, const PlanetSettings& planet);

/// Distance from the centre of Saturn with these frequencies, m. The planet's oblateness speeds orbits up by as much as
/// it slows epicycles down, so a³ = 2GM/(Ω² + κ²) holds up to J4; with κ = Ω it is Kepler's law.
double distance_from_saturn(const PlanetSettings& planet);

/// r_h = 0.82 (ρ / 900 kg m⁻³)^{1/3} (a / 10⁸ m): mutual Hill radius over radius sum of two equal particles
/// (Daisaka, Tanaka & Ida 2001). Aggregates form above about 1.1.
double hill_parameter(double density, double distance);

/// The particles that a layer is made of. A body of a list that holds much of the mass by itself counts by the mass of
/// the others: a single moonlet makes no thick layer.
struct Crowd {
  double mean_radius = 0.0; ///< ⟨r⟩, m
  double radius = 0.0;      ///< R, m: ⟨r³⟩/⟨r²⟩, each particle without the share that it has of the mass
};
Crowd crowd_of(const SizeLaw& sizes, std::size_t count);
inline Crowd crowd_of(const ParticleSettings& particles) {
  return crowd_of(particles.sizes, particles.count);
}

/// c_z / c_x of a fresh patch: equilibria without self-gravity have 0.64 to 0.72.
inline constexpr double vertical_fraction = 0.65;

/// Scale height √⟨z²⟩ of a layer in m, for a radial velocity dispersion in ⟨r⟩ Ω: H² = (c_z/ν)² + 1.7 τ R², where
/// c_z = vertical_share c_x. The second term is the room that the particles themselves take: equilibria of equal
/// spheres without self-gravity have H² − c_z²/ν² = 0.22, 0.89 and 1.66 r² at τ = 0.1, 0.5 and 1.
double layer_height(double optical_depth, const Crowd& crowd, double velocity_dispersion, double nu);

/// Mid-plane filling factor (4/3) τ R / (√(2π) H) of a Gaussian layer of that height.
double midplane_filling(double optical_depth, const Crowd& crowd, double velocity_dispersion, double nu);

/// The velocity dispersion (⟨r⟩ Ω) at which the mid-plane is filled to `filling`; 0 when it is never that full.
double dispersion_for_filling(double optical_depth, const Crowd& crowd, double nu, double filling);

/// The optical depth at which the mid-plane is filled to `filling`.
double optical_depth_for_filling(const Crowd& crowd, double velocity_dispersion, double nu, double filling);

/// The fullest mid-plane of a start. Where midplane_filling() is above it, the layer is given a flatter top instead, of
/// the same optical depth and height √⟨z²⟩, whose mid-plane is filled to this.
inline constexpr double largest_filling = 0.55;

/// The largest midplane_filling() that a scene may have: equal spheres jam at random at 0.64 (O'Hern et al. 2003).
inline constexpr double refused_filling = 0.62;

struct Derived {
  /// False when the particles come from a start file: then only the steps are known, and the other numbers are 0.
  bool particles_known = false;
  std::size_t particle_count = 0;
  double optical_depth = 0.0;
  double surface_density = 0.0; ///< kg/m²
  double lambda_cr = 0.0;       ///< m
  double toomre_q = 0.0;        ///< at the start
  double hill_parameter = 0.0;
  double midplane_filling = 0.0; ///< at the start, where streamlines are closest; at most largest_filling
  std::int64_t steps = 0;
  double memory_mb = 0.0; ///< estimate of the largest use, 10⁶ bytes
};

Derived derive(const Scene& scene);

/// Throws UsageError when a run of so many particles, in a patch like the scene's, needs more memory than can be had.
void require_memory_for(const Scene& scene, std::size_t count);

/// "tree, opening angle 0.6".
std::string in_words(const GravitySettings& gravity);

} // namespace keeler
