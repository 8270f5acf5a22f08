// All measurements of one snapshot, or their means over several snapshots of a run, in SI and under the names that
// `keeler analyze --json` prints.
#pragma once

#include <keeler/diagnostics/clusters.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/statistics/measured.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace keeler::diagnostics {

/// Self-gravity wakes in the autocorrelation (wakes.hpp).
struct Wakes {
  std::optional<double> pitch_degrees;       ///< in (−90, 90]; empty if no direction is significant
  std::optional<double> inner_pitch_degrees; ///< of the crest within λ_cr/2; empty if `pitch_degrees` is
  std::optional<double> outer_pitch_degrees; ///< beyond; empty if the crest falls below the noise before λ_cr
  std::optional<double> spacing;             ///< m; empty without wakes or a side maximum within half a box
  double amplitude = 0.0;                    ///< largest mean of ξ over such a line minus the mean over all directions

  double reach = 0.0;           ///< half the length of the lines averaged over, m
  double profile_spacing = 0.0; ///< m
  std::vector<double> profile;  ///< ξ averaged along the ridge, at radial lags 0, 1, 2 … × profile_spacing
};

/// Sizes and directions of wakes in several snapshots (wake_geometry.hpp).
struct WakeGeometry {
  Wakes mean;                               ///< of the mean autocorrelation
  double contrast = 0.0;                    ///< rms of the smoothed Σ/⟨Σ⟩ − 1
  statistics::Measured wavelength;          ///< λ_⊥, m
  statistics::Measured radial_wavelength;   ///< λ_x, m
  statistics::Measured angle_degrees;       ///< of the spectrum
  statistics::Measured inner_pitch_degrees; ///< of the ridge
  statistics::Measured outer_pitch_degrees; ///< of the ridge
};

/// Principal axes of the peculiar velocities (velocity_ellipsoid.hpp).
struct VelocityEllipsoid {
  double second_ratio = 0.0;             ///< shorter over longer principal axis in the plane; 0 without motion
  double vertical_ratio = 0.0;           ///< c_z over the longer one
  double vertex_deviation_degrees = 0.0; ///< from x to the longer axis, in (−90, 90], positive towards +y
};

/// Particles with smallest ≤ r < largest (the last class: ≤).
struct SizeClass {
  double smallest = 0.0;          ///< m
  double largest = 0.0;           ///< m
  std::size_t count = 0;          ///< number of particles
  double mass_fraction = 0.0;     ///< of the total mass
  Vec3 dispersion = Vec3::Zero(); ///< about the mean velocity of the whole patch, m rad⁻¹; 0 in an empty class
  double scale_height = 0.0;      ///< √⟨z²⟩, m; 0 in an empty class
};

/// Slope of a least-squares line through ln(value) over time.
struct Growth {
  double rate = 0.0; ///< per unit of time
  /// Standard error from the scatter about the line, corrected for correlated neighbours (statistical_inefficiency()
  /// in time_series.hpp; at equal intervals); empty for fewer than three values.
  std::optional<double> error;
};

/// A mode in several snapshots.
struct RadialModeAnalysis {
  int n = 0;                          ///< of k = 2π n / L_x
  double wavelength = 0.0;            ///< m
  double density_amplitude = 0.0;     ///< mean of |density|
  double density_phase_degrees = 0.0; ///< in the last snapshot: a crest is at x = −phase/k
  double speed = 0.0;                 ///< mean epicyclic speed, m/s
  std::optional<Growth> growth;       ///< of the epicyclic speed, in Ω
};

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
  std::size_t snapshots = 0;      ///< number of snapshots
  std::size_t particle_count = 0; ///< of the last snapshot
  double time_orbits = 0.0;       ///< of the last snapshot

  double mean_radius_m = 0.0;         ///< plain mean ⟨r⟩
  double optical_depth = 0.0;         ///< Σ π r² / area
  double surface_density_kg_m2 = 0.0; ///< total mass / area
  double critical_wavelength_m = 0.0; ///< λ_cr
  double toomre_q = 0.0;              ///< Q, from c_x

  std::array<double, 3> dispersion_m_s{};     ///< c_x, c_y, c_z
  std::array<double, 3> dispersion_r_omega{}; ///< these in ⟨r⟩ Ω
  double scale_height_m = 0.0;                ///< √⟨z²⟩
  double translational_viscosity_m2_s = 0.0;  ///< ⟨ẋ (ẏ + S x)⟩ / S without the mean motion
  double random_energy_m2_s2 = 0.0;           ///< ⟨½κ²e² + ½ν²i²⟩ per unit mass, without the mean motion

  std::optional<double> wake_pitch_degrees; ///< empty without wakes
  std::optional<double> wake_spacing_m;     ///< radial; empty without wakes or without a side maximum
  double wake_amplitude = 0.0;              ///< Wakes::amplitude
  WakeGeometry wakes;                       ///< in detail

  LocalAnalysis local;                          ///< around particles
  std::optional<WaveAnalysis> waves;            ///< empty if there are too few particles
  std::optional<SpinAnalysis> spins;            ///< empty for smooth particles
  ClusterAnalysis clusters;                     ///< of touching spheres
  std::vector<RadialModeAnalysis> radial_modes; ///< from the longest
  double radial_mode_noise = 0.0;               ///< rms density amplitude of a mode of random particles, one snapshot
  VelocityEllipsoid ellipsoid;                  ///< of the mean moments
  std::vector<SizeClass> size_classes;          ///< empty if all radii are equal; dispersions in m/s

  /// Sets `wakes` and the numbers that repeat parts of it.
  void take_wakes(const WakeGeometry& geometry);
};

/// Options of an analysis.
struct AnalysisSettings {
  double cluster_gap = default_cluster_gap; ///< largest gap of touching spheres / sum of their radii
  int radial_modes = 4;                     ///< number of modes, from the longest
};

/// Returns the means over the patches. Throws UsageError if there is no patch, a patch without particles, or patches of
/// different boxes.
Analysis analyze(std::span<const Patch> patches, const AnalysisSettings& settings = {});

} // namespace keeler::diagnostics
