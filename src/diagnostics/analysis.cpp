#include <keeler/diagnostics/analysis.hpp>

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/energy.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/viscosity.hpp>

namespace keeler {
namespace {

// Adds `share` of what one snapshot shows.
void add(Analysis& sum, const Patch& patch, double share) {
  const Vec3 dispersion = velocity_dispersion(patch);
  const Vec3 si = velocity_si(patch, dispersion), radii = velocity_in_radii(patch, dispersion);
  for (int axis = 0; axis < 3; ++axis) {
    sum.dispersion_m_s[static_cast<std::size_t>(axis)] += share * si[axis];
    sum.dispersion_r_omega[static_cast<std::size_t>(axis)] += share * radii[axis];
  }
  const double omega = patch.orbital_frequency;
  const PatchEnergy energy = patch_energy(patch);
  sum.mean_radius_m += share * mean_radius(patch);
  sum.optical_depth += share * optical_depth(patch);
  sum.surface_density_kg_m2 += share * surface_density(patch);
  sum.critical_wavelength_m += share * critical_wavelength(patch);
  sum.toomre_q += share * toomre_q(patch);
  sum.scale_height_m += share * scale_height(patch);
  sum.mean_eccentricity_m += share * mean_eccentricity(patch);
  sum.mean_inclination_m += share * mean_inclination(patch);
  sum.filling_factor += share * midplane_filling(patch);
  sum.translational_viscosity_m2_s += share * translational_viscosity(patch) * omega;
  sum.random_energy_m2_s2 += share * (energy.horizontal + energy.vertical) * omega * omega;
}

} // namespace

Analysis analyze(std::span<const Patch> patches) {
  if (patches.empty())
    throw UsageError("there is no snapshot to analyze; name a file or a run's folder that holds one");
  Analysis mean;
  mean.snapshots = patches.size();
  mean.particle_count = patches.back().size();
  mean.time_orbits = patches.back().time_orbits;
  for (const Patch& patch : patches) {
    if (patch.size() == 0)
      throw UsageError("a snapshot holds no particles, so there is nothing to measure; choose another one");
    add(mean, patch, 1.0 / static_cast<double>(patches.size()));
  }
  mean.wakes = wake_geometry(patches, mean.critical_wavelength_m);
  const Wakes& wakes = mean.wakes.mean;
  mean.wake_pitch_degrees = wakes.pitch_degrees;
  mean.wake_spacing_m = wakes.spacing;
  mean.wake_amplitude = wakes.amplitude;
  return mean;
}

} // namespace keeler
