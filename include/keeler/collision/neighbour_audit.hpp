// Are all neighbours known? In each step, for some of the particles, the plain search goes through all others and all
// images, and whoever may touch must be among those that the lists or the grid offer: at the beginning of the step, and
// at its end for some of the particles that were hit in it. It only looks.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace keeler {

/// A pair that may touch, by its straight lines in double precision, and that was not offered.
struct MissedNeighbour {
  std::uint64_t id = 0, other_id = 0; ///< the first one was searched for
  Image image;                        ///< of the other
  double distance = 0.0;              ///< of the centres at the epoch over the radius sum
  bool after_hit = false;             ///< at the end of the step; else at its beginning
};

struct NeighbourAudit {
  std::size_t particles = 16; ///< that are searched for at the beginning of a step, and at its end
  std::uint64_t steps = 0;    ///< audited so far: they draw the particles
  std::uint64_t pairs = 0;    ///< that the plain search found so far
  std::optional<MissedNeighbour> missed;
};

} // namespace keeler
