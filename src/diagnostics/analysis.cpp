#include <keeler/diagnostics/analysis.hpp>

#include "energy.hpp"
#include "local.hpp"
#include "size_classes.hpp"
#include "spin.hpp"
#include "velocity_ellipsoid.hpp"

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/epicyclic_waves.hpp>
#include <keeler/diagnostics/radial_modes.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/viscosity.hpp>
#include <keeler/diagnostics/wake_geometry.hpp>
#include <keeler/hill/toomre.hpp>

#include <algorithm>
#include <cmath>

namespace keeler::diagnostics {
namespace {

// Adds the values of one snapshot with this weight.
void add(Analysis& sum, const Patch& patch, double weight) {
  const Vec3 dispersion = velocity_dispersion(patch);
  const Vec3 si = velocity_si(patch, dispersion), radii = velocity_in_radii(patch, dispersion);
  for (int axis = 0; axis < 3; ++axis) {
    sum.dispersion_m_s[static_cast<std::size_t>(axis)] += weight * si[axis];
    sum.dispersion_r_omega[static_cast<std::size_t>(axis)] += weight * radii[axis];
  }
  const double omega = patch.orbital_frequency;
  const PatchEnergy energy = patch_energy(patch);
  sum.mean_radius_m += weight * mean_radius(patch);
  sum.optical_depth += weight * optical_depth(patch);
  sum.surface_density_kg_m2 += weight * surface_density(patch);
  sum.critical_wavelength_m += weight * critical_wavelength(patch);
  sum.toomre_q += weight * toomre_q(patch);
  sum.scale_height_m += weight * scale_height(patch);
  sum.translational_viscosity_m2_s += weight * translational_viscosity(patch) * omega;
  sum.random_energy_m2_s2 += weight * (energy.horizontal + energy.vertical) * omega * omega;
}

void add(LocalAnalysis& sum, const Patch& patch, double weight) {
  const double radius = local_radius(patch);
  const LocalMotion motion = local_motion(patch, radius);
  const Vec3 si = velocity_si(patch, motion.dispersion);
  const Crowding crowd = crowding(patch, crowding_radius(patch));
  sum.radius_m += weight * radius;
  for (int axis = 0; axis < 3; ++axis)
    sum.dispersion_m_s[static_cast<std::size_t>(axis)] += weight * si[axis];
  sum.toomre_q += weight * hill::toomre_q(newton_g(patch.orbital_frequency), surface_density(patch),
                                          patch.frequencies.kappa, motion.dispersion.x());
  sum.fraction += weight * motion.fraction;
  sum.crowding_radius_m += weight * crowding_radius(patch);
  sum.optical_depth += weight * crowd.optical_depth;
  sum.filling_factor += weight * crowd.filling;
  sum.thin_area_fraction += weight * crowd.thin_area;
  sum.thin_cell_m += weight * std::sqrt(crowd.cell_x * crowd.cell_y);
}

// Snapshots of a run hold equal particles: all have waves, or none has.
void add(std::optional<WaveAnalysis>& sum, const Patch& patch, double weight) {
  const std::optional<EpicyclicWaves> waves = epicyclic_waves(patch);
  if (!waves)
    return;
  if (!sum)
    sum.emplace();
  const Vec3 rest = waves->residual_dispersion(velocity_dispersion(patch));
  const Vec3 si = velocity_si(patch, rest), radii = velocity_in_radii(patch, rest);
  for (int axis = 0; axis < 3; ++axis) {
    sum->dispersion_m_s[static_cast<std::size_t>(axis)] += weight * si[axis];
    sum->dispersion_r_omega[static_cast<std::size_t>(axis)] += weight * radii[axis];
  }
  sum->energy_fraction += weight * waves->energy;
  sum->toomre_q += weight * hill::toomre_q(newton_g(patch.orbital_frequency), surface_density(patch),
                                           patch.frequencies.kappa, rest.x());
}

void add(std::optional<SpinAnalysis>& sum, const Patch& patch, double weight) {
  const std::optional<SpinState> spins = spin_state(patch);
  if (!spins)
    return;
  if (!sum)
    sum.emplace();
  for (int axis = 0; axis < 3; ++axis)
    sum->mean_omega[static_cast<std::size_t>(axis)] += weight * spins->mean[axis];
  sum->dispersion_omega += weight * spins->dispersion;
  sum->energy_ratio += weight * spins->energy_ratio;
}

void add(VelocityMoments& sum, const VelocityMoments& moments, double weight) {
  sum.xx += weight * moments.xx;
  sum.xy += weight * moments.xy;
  sum.yy += weight * moments.yy;
  sum.zz += weight * moments.zz;
}

// Snapshots of a run hold equal particles, and therefore equal classes.
void add(std::vector<SizeClass>& sum, const Patch& patch, double weight) {
  const std::vector<SizeClass> classes = size_classes(patch);
  if (sum.empty())
    for (const SizeClass& c : classes)
      sum.push_back({c.smallest, c.largest, c.count, c.mass_fraction, Vec3::Zero(), 0.0});
  for (std::size_t c = 0; c < std::min(sum.size(), classes.size()); ++c) {
    sum[c].dispersion += weight * velocity_si(patch, classes[c].dispersion);
    sum[c].scale_height += weight * classes[c].scale_height;
  }
}

} // namespace

void Analysis::take_wakes(const WakeGeometry& geometry) {
  wakes = geometry;
  wake_pitch_degrees = geometry.mean.pitch_degrees;
  wake_spacing_m = geometry.mean.spacing;
  wake_amplitude = geometry.mean.amplitude;
}

Analysis analyze(std::span<const Patch> patches, const AnalysisSettings& settings) {
  if (patches.empty())
    throw UsageError("there is no snapshot to analyze; name a file or a run's folder that holds one");
  Analysis mean;
  mean.snapshots = patches.size();
  mean.particle_count = patches.back().size();
  mean.time_orbits = patches.back().time_orbits;
  VelocityMoments moments;
  for (const Patch& patch : patches) {
    if (patch.size() == 0)
      throw UsageError("a snapshot holds no particles, so there is nothing to measure; choose another one");
    const double weight = 1.0 / static_cast<double>(patches.size());
    add(mean, patch, weight);
    add(mean.local, patch, weight);
    add(mean.waves, patch, weight);
    add(mean.spins, patch, weight);
    add(moments, velocity_moments(patch), weight);
    add(mean.size_classes, patch, weight);
  }
  mean.clusters = analyze_clusters(patches, settings.cluster_gap);
  mean.radial_modes = analyze_radial_modes(patches, settings.radial_modes);
  mean.radial_mode_noise = radial_mode_noise(patches.back());
  mean.ellipsoid = velocity_ellipsoid(moments);
  mean.take_wakes(wake_geometry(patches, mean.critical_wavelength_m));
  return mean;
}

} // namespace keeler::diagnostics
