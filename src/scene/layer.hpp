// The vertical structure of a fresh layer: its height and the filling factor of its mid-plane. SI units.
#pragma once

#include <keeler/particles/sizes.hpp>

#include <cstddef>

namespace keeler::scene {

/// Returns the mass per unit area (kg/m²) of particles of this law at optical depth 1, (4/3) ρ ⟨r³⟩/⟨r²⟩.
double surface_density_per_depth(const particles::SizeLaw& sizes, double density);

/// Mean sizes of the particles of a layer. A listed body that holds much of the mass by itself is weighted with the
/// mass of the other particles, so that a single moonlet does not make a thick layer.
struct LayerSizes {
  double mean_radius = 0.0;      ///< ⟨r⟩, m
  double effective_radius = 0.0; ///< R = ⟨r³⟩/⟨r²⟩, m, where each r³ is weighted by 1 − m/M, M the mass of all
};
/// Precondition: count > 0.
LayerSizes layer_sizes(const particles::SizeLaw& sizes, std::size_t count);

/// c_z / c_x of a fresh patch: equilibria without self-gravity have 0.64 to 0.72.
inline constexpr double vertical_fraction = 0.65;

/// Returns the scale height √⟨z²⟩ of a layer (m) for a radial velocity dispersion in ⟨r⟩ Ω: H² = (c_z/ν)² + 1.7 τ R²,
/// where c_z = vertical_fraction c_x. The second term is due to the particles' own volume: equilibria of equal spheres
/// without self-gravity have H² − c_z²/ν² = 0.22, 0.89 and 1.66 r² at τ = 0.1, 0.5 and 1.
double layer_height(double optical_depth, const LayerSizes& sizes, double velocity_dispersion, double nu);

/// Returns the mid-plane filling factor (4/3) τ R / (√(2π) H) of a Gaussian layer of that height.
double midplane_filling(double optical_depth, const LayerSizes& sizes, double velocity_dispersion, double nu);

/// Returns the velocity dispersion (⟨r⟩ Ω) at which midplane_filling() is `filling`; 0 if it is lower for all.
double dispersion_for_filling(double optical_depth, const LayerSizes& sizes, double nu, double filling);

/// Returns the optical depth at which midplane_filling() is `filling`.
double optical_depth_for_filling(const LayerSizes& sizes, double velocity_dispersion, double nu, double filling);

/// Upper limit of the mid-plane filling of a start. Where midplane_filling() is above it, the layer gets a flatter top
/// of this filling, with equal optical depth and height √⟨z²⟩.
inline constexpr double largest_filling = 0.55;

/// Upper limit of midplane_filling() in a scene: equal spheres jam at random at 0.64 (O'Hern et al. 2003).
inline constexpr double refused_filling = 0.62;

} // namespace keeler::scene
