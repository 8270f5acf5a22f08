#include <keeler/collision/restitution.hpp>

#include <keeler/collision/settings.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {

double RestitutionLaw::coefficient(double speed_si) const {
  if (kind == Kind::constant)
    return value;
  constexpr double centimetre = 0.01;
  return speed_si > 0.0 ? std::min(1.0, scale * std::pow(speed_si / centimetre, -0.234)) : 1.0;
}

Rebound rebound(const CollisionSettings& settings, double approach_speed, double radius_sum, double orbital_frequency) {
  const double cut = settings.cut_speed(radius_sum);
  const bool fast = approach_speed >= cut;
  const double kept = fast ? settings.restitution.coefficient(approach_speed * orbital_frequency) : 1.0;
  return {std::max(kept * approach_speed, 1e-3 * cut), fast};
}

} // namespace keeler
