#include <keeler/diagnostics/surface.hpp>

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/hill/toomre.hpp>

#include <algorithm>
#include <cmath>

namespace keeler::diagnostics {

double optical_depth(const Patch& patch) {
  const double squares = ordered_sum(patch.size(), [&](std::size_t k) { return patch.radii[k] * patch.radii[k]; });
  return pi * squares / patch.box.area();
}

double surface_density(const Patch& patch) {
  return total_mass(patch) / patch.box.area();
}

double material_density(const Patch& patch) {
  const double cubes = ordered_sum(patch.size(), [&](std::size_t k) { return std::pow(patch.radii[k], 3); });
  return total_mass(patch) / (4.0 / 3.0 * pi * cubes);
}

double midplane_filling(const Patch& patch) {
  const double squares = ordered_sum(patch.size(), [&](std::size_t k) {
    const double z = patch.positions[k].z();
    return std::max(0.0, patch.radii[k] * patch.radii[k] - z * z);
  });
  return pi * squares / patch.box.area();
}

double critical_wavelength(const Patch& patch) {
  return hill::critical_wavelength(newton_g(patch.orbital_frequency), surface_density(patch), patch.frequencies.kappa);
}

double toomre_q(const Patch& patch) {
  return hill::toomre_q(newton_g(patch.orbital_frequency), surface_density(patch), patch.frequencies.kappa,
                        velocity_dispersion(patch).x());
}

} // namespace keeler::diagnostics
