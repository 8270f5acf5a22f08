#include <keeler/forces/force.hpp>

#include "constant_acceleration.hpp"

#include <keeler/forces/satellite.hpp>

namespace keeler {

const std::vector<ForceEntry>& external_forces() {
  static const std::vector<ForceEntry> forces = {constant_acceleration_entry(), satellite_entry()};
  return forces;
}

} // namespace keeler
