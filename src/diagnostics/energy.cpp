#include "energy.hpp"

#include <keeler/diagnostics/mean.hpp>

namespace keeler::diagnostics {

PatchEnergy patch_energy(const Patch& patch) {
  const Frequencies& f = patch.frequencies;
  const auto mean_of = [&](const auto& part) {
    return mass_mean(patch, [&](std::size_t k) {
      return part(elements_from({patch.positions[k], patch.velocities[k]}, f, Rotation()));
    });
  };
  const double k2 = f.kappa * f.kappa;
  PatchEnergy mean;
  mean.horizontal = mean_of([&](const Elements& el) { return 0.5 * k2 * el.eccentricity() * el.eccentricity(); });
  mean.vertical = mean_of([&](const Elements& el) { return 0.5 * f.nu * f.nu * el.inclination() * el.inclination(); });
  return mean;
}

} // namespace keeler::diagnostics
