// Ghost bookkeeping: the store holds the rank's own particles first, then ghosts received from other ranks.
//
// Slabs cut the box across x. An own particle's reference is its x when the layer was built. Invariant: until the layer
// is rebuilt, no own particle of any rank moves farther than `margin` from its reference along x. So an own particle
// can touch only own particles and near ghosts, which have a reference within two margins and two largest radii of
// the slab. src/collision/distributed_drift.cpp says what the ghosts farther out are for.
#pragma once

#include <keeler/hill/elements.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::decomposition {

struct GhostLayer {
  std::size_t own = 0;                          ///< number of own particles
  std::vector<std::vector<std::uint32_t>> sent; ///< per rank: ascending indices of the own particles sent to it
  std::vector<std::uint8_t> is_sent;            ///< per own particle: is it a ghost on any other rank?
  std::vector<std::size_t> first; ///< ghosts from rank r are at [first[r], first[r + 1]), in the order of its `sent`
  std::vector<std::uint8_t> near; ///< per ghost, from the first on: may an own particle touch it?
  std::vector<double> references; ///< x of each own particle when the layer was built, m
  double margin = 0.0;            ///< largest distance from the reference, m
  double size_x = 0.0;            ///< of the box, m
  double kappa = 1.0;             ///< epicyclic frequency, in units of the orbital one

  std::size_t ghosts() const { return near.size(); }

  /// Returns the largest distance along x from the reference, m, that a path reaches from half a step before to half a
  /// step after the epoch.
  double excursion(double reference, const Elements& el, double step) const {
    double distance = x_at_epoch(el) - reference;
    if (std::fabs(distance) > 0.5 * size_x)
      distance = std::remainder(distance, size_x);
    return std::fabs(distance) + 0.5 * step * kappa * el.eccentricity();
  }
  /// True if two ranks hold the particle at this index of the store.
  bool on_two_ranks(std::size_t index) const {
    assert(index < own + ghosts());
    return index >= own || is_sent[index];
  }
  /// True if an own particle stays within the margin on this path.
  bool within_margin(std::size_t index, const Elements& el, double step) const {
    assert(index < own);
    return excursion(references[index], el, step) <= margin;
  }

  /// Returns x at the epoch, m.
  static double x_at_epoch(const Elements& el) { return el.guiding_x - el.e_cos; }
};

} // namespace keeler::decomposition
