// A sphere that is placed without overlap.
#pragma once

#include <keeler/core/vector.hpp>

#include <cstdint>

namespace keeler::initial_conditions {

struct Sphere {
  Vec3 position;          ///< m
  double radius;          ///< m
  double height;          ///< drawn z, m
  std::uint32_t particle; ///< number of its particle
  bool held = false;      ///< never moves

  /// Returns the mass in units of 4/3 π × density; a held sphere is so heavy that no push moves it.
  double mass() const { return held ? 1e200 : radius * radius * radius; }
};

} // namespace keeler::initial_conditions
