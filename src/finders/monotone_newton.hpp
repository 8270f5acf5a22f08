// Newton's method for the first contact of many pairs at once, with a proof that the distance decreases up to it.
//
// Most pairs approach steadily. For them bounds on the derivatives of f = |d|² − R² over the rest of the step prove,
// from one or two evaluations, that there is no contact, or that f decreases from the start of the search to the root
// found, which is therefore the first. Pairs without a proof stay undecided. docs/theory/finders.md has the proof.
//
// Only plain numbers, since the kernels are compiled for several instruction sets, with bit-identical results.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>
#include <cstdint>

namespace keeler::finders {

/// A pair: the eight numbers of each body (particles/store.hpp); the shift of `high` in x and y and the start of the
/// search, contiguous in a query. Pointers, since recently written numbers are slow to read as vectors.
struct MonotonePair {
  const double *low, *high, *query;
};

/// A step, and constants derived from its frequencies.
struct MonotoneStep {
  double kappa, nu, shear, two_over_kappa;
  double begin, end;
  double largest_angle; ///< of a rotation within the step, rad: sets the number of terms of a sine
};

/// Limits of the kernels: the largest angle (pi/4), and the epicyclic frequency up to which their bounds hold.
inline constexpr double monotone_angle = 0.785398163397448, monotone_kappa = 2.0;

enum class MonotoneExit : std::int32_t { undecided, hit, overlapping, receding, missed };

struct MonotoneAnswer {
  double time; ///< of a contact
  MonotoneExit exit;
  std::int32_t evaluations;
};

inline constexpr std::size_t max_lanes = 8;

/// A search in several lanes at once: always reads `lanes` pairs and writes as many answers.
struct MonotoneNewton {
  std::size_t lanes;
  void (*find)(const MonotonePair* pairs, const MonotoneStep& step, MonotoneAnswer* answers);
};

MonotoneNewton monotone_newton(InstructionSet set);

} // namespace keeler::finders
