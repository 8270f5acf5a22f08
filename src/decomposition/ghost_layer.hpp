// Ghost bookkeeping: the store holds the rank's own particles first, then ghosts received from other ranks.
//
// An own particle's reference is its position when the layer was built, and moves with the shear from then on: two
// references of nearly equal x stay close. Invariant: until the layer is rebuilt, no own particle of any rank moves
// farther than `margin` from its reference along x, nor twice that along y (epicycles are twice as long as wide). So an
// own particle can touch only own particles and near ghosts, whose references were within near_reach() of the rank's
// block. src/collision/distributed_drift.cpp says what the ghosts farther out are for.
#pragma once

#include <keeler/cells/folds.hpp>
#include <keeler/decomposition/block_grid.hpp>
#include <keeler/hill/elements.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::decomposition {

/// The middle of a step, which elements refer to.
struct Epoch {
  double time = 0.0;   ///< since any fixed time, rad
  double offset = 0.0; ///< the box's shear offset, m
  double step = 0.0;   ///< length of the step, rad
};

/// A position of the cell in 2⁻³² of the box, which saves half the memory of a Point.
struct BoxPoint {
  std::int32_t x = 0, y = 0;
};

struct GhostLayer {
  std::size_t own = 0;                          ///< number of own particles
  std::vector<std::vector<std::uint32_t>> sent; ///< per rank: ascending indices of the own particles sent to it
  std::vector<std::uint8_t> is_sent;            ///< per own particle: is it a ghost on any other rank?
  std::vector<std::size_t> first;    ///< ghosts from rank r are at [first[r], first[r + 1]), in the order of its `sent`
  std::vector<std::size_t> partners; ///< ranks that ghosts are sent to or received from, ascending
  std::vector<std::uint8_t> near;    ///< per ghost, from the first on: may an own particle touch it?
  std::vector<BoxPoint> references;  ///< position of each own particle when the layer was built
  std::vector<std::uint16_t> contacts; ///< of each own particle since then: counted by the drift
  std::uint32_t steps = 0;             ///< since then, likewise
  double margin = 0.0;                 ///< largest distance from the reference along x, and half of that along y, m
  bool has_rows = false;               ///< false: blocks are as long as the box, so that y does not matter
  ShearingBox box;
  double kappa = 1.0;    ///< epicyclic frequency, in units of the orbital one
  double built_at = 0.0; ///< time of the epoch at which the layer was built, rad
  Epoch epoch;           ///< of the present step
  cells::Folds folds;    ///< the own particles and the ghosts are in such a part of the box, but for images

  std::size_t ghosts() const { return near.size(); }

  /// Returns the largest distance from the reference, m, that a path reaches from half a step before to half a step
  /// after the epoch; along y half of it counts.
  double excursion(const Point& reference, const Elements& el) const;
  /// Returns the distances from a block within which references of near ghosts lie, in a layer that no particle uses
  /// for longer than `lifetime` (rad). Two references at a distance x move apart by S x lifetime at most.
  Point near_reach(double max_radius, double lifetime) const;

  /// True if two ranks hold the particle at this index of the store.
  bool on_two_ranks(std::size_t index) const {
    assert(index < own + ghosts());
    return index >= own || is_sent[index];
  }
  /// True if an own particle stays within the margin on this path in the present step.
  bool within_margin(std::size_t index, const Elements& el) const {
    assert(index < own);
    return excursion(references[index], el) <= margin;
  }
  double excursion(const BoxPoint& reference, const Elements& el) const { return excursion(point(reference), el); }

  Point point(const BoxPoint& at) const { return {at.x * (box.size_x / turn), at.y * (box.size_y / turn)}; }
  BoxPoint box_point(const Point& in_cell) const {
    const auto fraction = [](double position, double size) {
      const double rounded = std::nearbyint(position / size * turn); // may be no number
      return rounded < 0.5 * turn ? static_cast<std::int32_t>(std::max(rounded, -0.5 * turn)) : INT32_MAX;
    };
    return {fraction(in_cell.x, box.size_x), fraction(in_cell.y, box.size_y)};
  }

  /// Returns the position in the plane at the epoch.
  Point position(const Elements& el) const {
    return {el.guiding_x - el.e_cos, el.guiding_y + (2.0 / kappa) * el.e_sin};
  }

private:
  static constexpr double turn = 4294967296.0; // 2³²
};

} // namespace keeler::decomposition
