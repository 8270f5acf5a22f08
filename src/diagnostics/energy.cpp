#include "energy.hpp"

#include <keeler/diagnostics/mean.hpp>

#include <cmath>

namespace keeler::diagnostics {

PatchEnergy patch_energy(const Patch& patch) {
  const Frequencies& f = patch.frequencies;
  const auto mean_of = [&](const auto& part) {
    return mass_mean(patch, [&](std::size_t k) {
      return part(elements_from({patch.positions[k], patch.velocities[k]}, f, Rotation()));
    });
  };
  const auto variance = [&](double Elements::*first, double Elements::*second) { // of a vector
    const double x = mean_of([&](const Elements&el) { return el.*first; }),
                 y = mean_of([&](const Elements&el) { return el.*second; });
    return mean_of([&](const Elements& el) { return std::pow(el.*first - x, 2) + std::pow(el.*second - y, 2); });
  };
  PatchEnergy mean;
  mean.horizontal = 0.5 * f.kappa * f.kappa * variance(&Elements::e_cos, &Elements::e_sin);
  mean.vertical = 0.5 * f.nu * f.nu * variance(&Elements::i_sin, &Elements::i_cos);
  return mean;
}

} // namespace keeler::diagnostics
