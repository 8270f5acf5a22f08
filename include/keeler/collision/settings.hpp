// What a scene says about collisions.
#pragma once

#include <keeler/collision/restitution.hpp>

#include <string>

namespace keeler {

struct CollisionSettings {
  std::string finder = "certified"; ///< a name of finder_table()
  RestitutionLaw restitution;
  double elastic_below = 1e-2; ///< v_cut in units of (r_i + r_j) Omega / 2: slower contacts bounce elastically
};

} // namespace keeler
