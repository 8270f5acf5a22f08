// All measurements of one snapshot, or their means over several snapshots of a run, in SI and under the names that
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

/// Means over the surroundings of particles (local.hpp).
struct LocalAnalysis {
  double radius_m = 0.0;                  ///< of the neighbourhood used to subtract the mean velocity
  std::array<double, 3> dispersion_m_s{}; ///< of the random motion in it
  double toomre_q = 0.0;                  ///< by its x component and the mean surface density of the patch
  double fraction = 0.0;                  ///< fraction of the mass in particles with a neighbour
  double crowding_radius_m = 0.0;         ///< of the disc in which density is counted
  double optical_depth = 0.0;             ///< local, mean over particles
  double filling_factor = 0.0;            ///< local at z = 0, mean over particles
  double thin_area_fraction = 0.0;        ///< of cells with an optical depth below 0.1
  double thin_cell_m = 0.0;               ///< side of these cells (of a square of the same area)
};

/// Spins of rough particles, relative to the stars (spin.hpp).
struct SpinAnalysis {
  std::array<double, 3> mean_omega{}; ///< ⟨ω⟩, Ω
  double dispersion_omega = 0.0;      ///< √⟨(ω − ⟨ω⟩)²⟩, Ω
  double energy_ratio = 0.0;          ///< energy of the spins about their mean / energy of the random motion
};

/// Box-long axisymmetric waves: their part of the motion, and the motion without them (epicyclic_waves.hpp).
struct WaveAnalysis {
  double energy_fraction = 0.0;               ///< fraction of the epicyclic energy
  std::array<double, 3> dispersion_m_s{};     ///< c_x, c_y, c_z about the velocity field of the waves
  std::array<double, 3> dispersion_r_omega{}; ///< these in ⟨r⟩ Ω
  double toomre_q = 0.0;                      ///< from this c_x
};

/// Means over the snapshots; wakes are measured on the mean autocorrelation.
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
  std::array<double, 3> dispersion_r_omega{}; ///< these in ⟨r⟩ Ω
  double scale_height_m = 0.0;
  double translational_viscosity_m2_s = 0.0;
  double random_energy_m2_s2 = 0.0; ///< ⟨½κ²e² + ½ν²i²⟩ per unit mass

  std::optional<double> wake_pitch_degrees; ///< empty without wakes
  std::optional<double> wake_spacing_m;     ///< radial; empty without wakes or without a side maximum
  double wake_amplitude = 0.0;
  WakeGeometry wakes;

  LocalAnalysis local;
  std::optional<WaveAnalysis> waves; ///< empty if there are too few particles
  std::optional<SpinAnalysis> spins; ///< empty for smooth particles
  ClusterAnalysis clusters;
  std::vector<RadialModeAnalysis> radial_modes;
  double radial_mode_noise = 0.0;      ///< rms density amplitude of a mode of random particles, one snapshot
  VelocityEllipsoid ellipsoid;         ///< of the mean moments
  std::vector<SizeClass> size_classes; ///< empty if all radii are equal; dispersions in m/s

  void take_wakes(const WakeGeometry& geometry);
};

/// Options of an analysis.
struct AnalysisSettings {
  double cluster_gap = default_cluster_gap; ///< largest gap of touching spheres / sum of their radii
  int radial_modes = 4;                     ///< number of modes, from the longest
};

/// Throws UsageError if there is no patch, a patch without particles, or patches of different boxes.
Analysis analyze(std::span<const Patch> patches, const AnalysisSettings& settings = {});

} // namespace keeler
