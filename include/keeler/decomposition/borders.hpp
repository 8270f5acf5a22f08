// Who has copies of whom: a rank's own particles stand first in its store, copies of other ranks' behind.
//
// Slabs cut the box across, by where particles stood when the borders were made, their references. Until they are made
// anew no own particle of any rank may go farther across from its reference than the margin. So an own particle can
// touch nobody but own ones and the near copies, whose references are within two margins and two radii of the slab.
// What copies beyond these are there for is told in collision/distributed_drift.cpp.
#pragma once

#include <keeler/hill/elements.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler {

struct Borders {
  std::size_t own = 0;                          ///< particles
  std::vector<std::vector<std::uint32_t>> lent; ///< to each rank copies of these own ones, by place
  std::vector<std::uint8_t> is_lent;            ///< each own one: whether somebody has a copy
  std::vector<std::size_t> first; ///< copies of rank r's stand in [first[r], first[r + 1]), in the order it lent them
  std::vector<std::uint8_t> near; ///< each copy, from the first one on: whether an own particle may touch it
  std::vector<double> references; ///< of the own ones, m
  double margin = 0.0;            ///< m
  double size_x = 0.0;            ///< of the box, m
  double kappa = 1.0;             ///< epicyclic frequency

  /// How far across a path leads from that reference at most, from half a step before to half a step after the epoch.
  double way(double reference, const Elements& el, double step) const {
    double distance = place_across(el) - reference;
    if (std::fabs(distance) > 0.5 * size_x)
      distance = std::remainder(distance, size_x);
    return std::fabs(distance) + 0.5 * step * kappa * el.eccentricity();
  }
  /// Whether two ranks have it.
  bool has_copies(std::size_t place) const { return place >= own || is_lent[place]; }
  bool keeps(std::size_t place, const Elements& el, double step) const {
    return way(references[place], el, step) <= margin;
  }

  /// At the epoch, m.
  static double place_across(const Elements& el) { return el.guiding_x - el.e_cos; }
};

} // namespace keeler
