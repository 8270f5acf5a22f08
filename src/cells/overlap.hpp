// Overlaps of particles: the check at the end of every run and when a state is loaded.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace keeler::cells {

/// The pair that overlaps most.
struct Overlap {
  double depth = 0.0; ///< (r_i + r_j − distance) / (r_i + r_j); 0 if nothing overlaps
  std::uint64_t id_i = 0, id_j = 0;
};

/// True if a is deeper than b; at equal depth, if a has the lower ids.
bool deeper(const Overlap& a, const Overlap& b);

/// Returns the deepest overlap over all pairs and images of a patch.
Overlap largest_overlap(const Patch& patch);

/// Returns the number of pairs that overlap by more than `depth`.
std::size_t count_overlaps(const Patch& patch, double depth);

/// Largest overlap, relative to the radius sum, from which a run can start; the inexact finders stay below it.
inline constexpr double allowed_overlap = 1e-8;

/// Throws InvariantError if so many particles of `state` are piled up that a search for pairs would not end: N
/// particles at one position have N² pairs. Costs a sort.
void require_no_heap(const Patch& patch, const std::string& state);

/// Throws InvariantError if particles are piled up, or overlap by more than allowed_overlap, naming the worst pair of
/// `state` ("the initial state").
void require_no_overlap(const Patch& patch, const std::string& state);
void require_no_overlap(const Overlap& largest, const std::string& state);

} // namespace keeler::cells
