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
  bool held = false;      ///< it stays where it is

  /// In 4/3 π times the density; of a held sphere so large that no push moves it.
  double mass() const { return held ? 1e200 : radius * radius * radius; }
};

} // namespace keeler
