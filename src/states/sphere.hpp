// What is placed without overlap.
#pragma once

#include <keeler/core/vector.hpp>

#include <cstdint>

namespace keeler {

struct Sphere {
  Vec3 place;             ///< m
  double radius;          ///< m
  double height;          ///< z that was drawn for it, m
  std::uint32_t particle; ///< whose it is

  /// In 4/3 π times the density.
  double mass() const { return radius * radius * radius; }
};

} // namespace keeler
