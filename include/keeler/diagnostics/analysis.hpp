// Everything measured on one snapshot, or averaged over several of one run, in SI and under the names that
// `keeler analyze --json` prints.
#pragma once

#include <keeler/diagnostics/clusters.hpp>
#include <keeler/diagnostics/radial_modes.hpp>
#include <keeler/diagnostics/size_classes.hpp>
#include <keeler/diagnostics/velocity_ellipsoid.hpp>
#include <keeler/diagnostics/wake_geometry.hpp>
#include <keeler/particles/patch.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace keeler {

/// What particles meet where they are (local.hpp).
struct LocalAnalysis {
  double radius_m = 0.0;                  ///< of the neighbourhood whose mean velocity is taken out
  std::array<double, 3> dispersion_m_s{}; ///< of the random motion in it
  double toomre_q = 0.0;                  ///< by its x component and the mean surface density of the patch
  double share = 0.0;                     ///< of the mass: particles with a neighbour
  double crowding_radius_m = 0.0;         ///< of the disc in which density is counted
  double optical_depth = 0.0;             ///< that the mean particle sees
  double filling_factor = 0.0;            ///< at z = 0, that the mean particle sees
  double thin_area_fraction = 0.0;        ///< of the cells, those with an optical depth below 0.1
  double thin_cell_m = 0.0;               ///< side of these cells (of a square of the same area)
};

/// Spins of rough particles, against the stars (spin.hpp).
struct SpinAnalysis {
  std::array<double, 3> mean_omega{}; ///< ⟨ω⟩, Ω
  double dispersion_omega = 0.0;      ///< √⟨(ω − ⟨ω⟩)²⟩, Ω
  double energy_ratio = 0.0;          ///< energy of the spins about their mean over that of the random motion
};

/// What axisymmetric waves as long as the box hold of the motion, and the motion without them (epicyclic_waves.hpp).
struct WaveAnalysis {
  double energy_fraction = 0.0;               ///< of the epicyclic energy
  std::array<double, 3> dispersion_m_s{};     ///< c_x, c_y, c_z about the velocity field of the waves
  std::array<double, 3> dispersion_r_omega{}; ///< the same in ⟨r⟩ Ω
  double toomre_q = 0.0;                      ///< by this c_x
};

/// Means over the snapshots; the wakes are those of the mean autocorrelation.
struct Analysis {
  std::size_t snapshots = 0;
  std::size_t particle_count = 0;
  double time_orbits = 0.0; ///< of the last snapshot

  double mean_radius_m = 0.0;
  double optical_depth = 0.0;
  double surface_density_kg_m2 = 0.0;
  double critical_wavelength_m = 0.0;
  double toomre_q = 0.0;

  std::array<double, 3> dispersion_m_s{};     ///< c_x, c_y, c_z
  std::array<double, 3> dispersion_r_omega{}; ///< the same in ⟨r⟩ Ω
  double scale_height_m = 0.0;
  double translational_viscosity_m2_s = 0.0;
  double random_energy_m2_s2 = 0.0; ///< ⟨½κ²e² + ½ν²i²⟩ per unit mass

  std::optional<double> wake_pitch_degrees; ///< none: no wakes
  std::optional<double> wake_spacing_m;     ///< radial; none: no wakes or no side maximum
  double wake_amplitude = 0.0;
  WakeGeometry wakes;

  LocalAnalysis local;
  std::optional<WaveAnalysis> waves; ///< none: too few particles
  std::optional<SpinAnalysis> spins; ///< none: smooth particles
  ClusterAnalysis clusters;
  std::vector<RadialModeAnalysis> radial_modes;
  double radial_mode_noise = 0.0;      ///< rms density amplitude of a mode if particles stood at random, one snapshot
  VelocityEllipsoid ellipsoid;         ///< of the mean moments
  std::vector<SizeClass> size_classes; ///< none when all radii are equal; dispersions in m/s

  void take_wakes(const WakeGeometry& geometry);
};

/// What can be chosen in an analysis.
struct AnalysisSettings {
  double cluster_gap = default_cluster_gap; ///< between touching spheres, over the sum of their radii
  int radial_modes = 4;                     ///< how many, from the longest on
};

/// Throws UsageError when there is no patch, a patch without particles, or patches of different boxes.
Analysis analyze(std::span<const Patch> patches, const AnalysisSettings& settings = {});

} // namespace keeler
