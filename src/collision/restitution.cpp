#include <keeler/collision/restitution.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {

double RestitutionLaw::coefficient(double speed_si) const {
  if (kind == Kind::constant)
    return value;
  constexpr double centimetre = 0.01;
  return speed_si > 0.0 ? std::min(1.0, scale * std::pow(speed_si / centimetre, -0.234)) : 1.0;
}

} // namespace keeler
