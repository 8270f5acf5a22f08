// How deep particles stand inside each other: the check that every run ends with and every loader makes.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace keeler {

/// The pair that overlaps most.
struct Overlap {
  double depth = 0.0; ///< (r_i + r_j − distance) / (r_i + r_j); 0 when nothing overlaps
  std::uint64_t id_i = 0, id_j = 0;
};

/// Which of two counts as the larger: of equal depths the one with the lower ids.
bool deeper(const Overlap& a, const Overlap& b);

/// Over all pairs and images of a patch.
Overlap largest_overlap(const Patch& patch);

/// How many pairs overlap by more than `depth`.
std::size_t count_overlaps(const Patch& patch, double depth);

/// An overlap from which no run starts, of a radius sum: contacts by the inexact finders are below it.
inline constexpr double allowed_overlap = 1e-8;

/// Throws InvariantError where so many particles of `state` lie in one place that whatever looks at pairs would not
/// end: N in one place have N² pairs. Takes the time of a sort.
void require_no_heap(const Patch& patch, const std::string& state);

/// Throws InvariantError where particles are in heaps, or overlap by more than that, naming the worst pair of `state`
/// ("the initial state").
void require_apart(const Patch& patch, const std::string& state);
void require_apart(const Overlap& largest, const std::string& state);

} // namespace keeler
