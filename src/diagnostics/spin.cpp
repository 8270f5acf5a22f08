#include "spin.hpp"

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>

#include <cassert>
#include <cmath>

namespace keeler::diagnostics {

std::optional<SpinState> spin_state(const Patch& patch) {
  if (patch.spins.empty())
    return std::nullopt;
  assert(patch.spins.size() == patch.size());
  SpinState state;
  for (int axis = 0; axis < 3; ++axis)
    state.mean[axis] = mass_mean(patch, [&](std::size_t k) { return patch.spins[k][axis]; });
  const auto square = [&](std::size_t k) { return (patch.spins[k] - state.mean).squaredNorm(); };
  state.dispersion = std::sqrt(mass_mean(patch, square));
  const double spins = 0.2 * mass_mean(patch, [&](std::size_t k) { return std::pow(patch.radii[k], 2) * square(k); });
  const double motion = 0.5 * velocity_dispersion(patch).squaredNorm();
  state.energy_ratio = motion > 0.0 ? spins / motion : 0.0;
  return state;
}

} // namespace keeler::diagnostics
