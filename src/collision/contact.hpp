// What one contact did: the row that the loops over contacts hand to the sums of the step.
#pragma once

#include <cstdint>

namespace keeler::collision {

/// Energies in kg m² rad⁻².
struct Contact {
  double time = 0.0;
  double energy_lost = 0.0;
  double momentum_flux = 0.0;      ///< kg m² rad⁻¹
  double kick_work = 0.0;          ///< gravity's, beyond that of its kicks
  double azimuthal_gain = 0.0;     ///< of Σ m c_y², kg m² rad⁻²
  bool fast = false;               ///< faster than v_cut
  bool unresolved = false;         ///< slower than what a kick of the pair's own gravity gives
  bool recontact = false;          ///< the last contact of both particles in this step was with each other
  float slow = 0.0F;               ///< of a possible contact at rest: its speed in kicks of the pair's own gravity
  std::uint32_t low = 0, high = 0; ///< indices of the particles, the lower id first
};

} // namespace keeler::collision
