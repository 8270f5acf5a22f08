// The division of the box into domains of contacts: each round cuts it into a grid of blocks. The second round's
// blocks are shifted by half a block in both directions. The third's are shifted by a quarter, so the places where
// edges of the first two cross are in their middle parts. The domain of the last round is the whole box.
//
// Invariant: in each round every position belongs to exactly one domain. Across the x edge of the box, shifted blocks
// hold images, which the shear has moved along the box.
#pragma once

#include "neighbours/line.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace keeler::collision {

class DomainCut {
public:
  static constexpr std::size_t rounds = 4;
  /// Largest number of domains per round.
  static constexpr std::size_t max_domains = 1364;
  /// The same of all rounds.
  static constexpr std::size_t max_in_all = (rounds - 1) * max_domains + 1;

  /// Cuts the box into at most `domains` blocks per round, nearly square in a box whose sides have this ratio. Images
  /// across the outer x edge are moved by `offset_y` along the box. Precondition: 0 < domains <= max_domains.
  void cut(std::size_t domains, double x_over_y, std::uint32_t offset_y) {
    assert(domains > 0 && domains <= max_domains && x_over_y > 0.0);
    const double square = std::sqrt(static_cast<double>(domains) * x_over_y); // columns of square blocks
    columns_ = static_cast<std::uint32_t>(std::clamp(std::rint(square), 1.0, static_cast<double>(domains)));
    rows_ = static_cast<std::uint32_t>(domains / columns_);
    offset_y_ = offset_y;
  }

  /// Returns the number of domains of all rounds, which are numbered round by round: [begin_of(r), end_of(r)).
  std::size_t domains() const { return (rounds - 1) * per_round() + 1; }
  std::size_t begin_of(std::size_t round) const { return round * per_round(); }
  std::size_t end_of(std::size_t round) const { return std::min((round + 1) * per_round(), domains()); }

  /// Returns the number, within its round, of the domain that owns a position.
  std::size_t owner(std::size_t round, const BoxPosition& position) const {
    if (round + 1 == rounds)
      return 0;
    const BoxPosition p = in_grid(round, position);
    return (std::uint64_t{p.x} * columns_ >> 32) * rows_ + (std::uint64_t{p.y} * rows_ >> 32);
  }

  /// True if everything within `distance` of a position, across the edges of the box too, has the same owner.
  bool is_inside(std::size_t round, const BoxPosition& position, const BoxDistance& distance) const {
    if (round + 1 == rounds)
      return true;
    const BoxPosition p = in_grid(round, position);
    return is_inside(p.x * columns_, distance.x * columns_) && is_inside(p.y * rows_, distance.y * rows_);
  }

private:
  std::size_t per_round() const { return std::size_t{columns_} * rows_; }

  // Returns a position relative to the grid of a round.
  BoxPosition in_grid(std::size_t round, const BoxPosition& position) const {
    if (round == 0)
      return position;
    const std::uint32_t part = std::uint32_t{1} << (32 - round), shift_x = part / columns_, shift_y = part / rows_;
    const std::uint32_t x = position.x + shift_x;
    const bool beyond = x < shift_x; // in the first column, as an image
    return {x, position.y + shift_y + (beyond ? offset_y_ : 0)};
  }
  // `place`, in the units of a block's side, is farther than `distance` from both ends.
  static bool is_inside(std::uint32_t place, std::uint64_t distance) {
    return place > distance && place + distance < std::uint64_t{1} << 32;
  }

  std::uint32_t columns_ = 1, rows_ = 1; // of blocks
  std::uint32_t offset_y_ = 0;
};

} // namespace keeler::collision
