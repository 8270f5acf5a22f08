// When the wakes of a patch have settled. Their amplitude (Wakes::amplitude, diagnostics/wakes.hpp) grows for about two
// orbits, overshoots, and then wanders for ever, by tens of per cent from one dynamical time to the next, because a box
// holds few wakes that form and dissolve. So means over one orbit are compared: wakes have settled when the mean
// over the last orbit differs from the mean over the orbit before it by no more than such means differ for ever.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace keeler {

/// docs/dev/diagnostics.md has the runs from which these numbers were chosen.
struct SettleCriterion {
  double samples_per_orbit = 16.0;
  double window_orbits = 1.0;   ///< length of a mean
  double largest_change = 0.15; ///< between two means, of the later one
  double most_orbits = 10.0;    ///< not settled by then: never
};

/// The wakes at one instant.
struct WakeSample {
  double orbits = 0.0;
  double amplitude = 0.0;
  bool standing = false; ///< they stand out of the noise
};

/// The last two windows of a history.
struct Settling {
  double amplitude = 0.0; ///< mean over the last window
  double before = 0.0;    ///< mean over the window before it
  double change = 0.0;    ///< |amplitude − before| / amplitude; infinite when there is no amplitude
  bool standing = false;  ///< in every sample of the last window
};

/// Compares the last `window` samples with as many before them; none as long as there are fewer than two windows.
std::optional<Settling> compare_windows(std::span<const WakeSample> history, std::size_t window);

/// There are wakes, and they change no more.
inline bool settled(const Settling& settling, const SettleCriterion& criterion) {
  return settling.standing && settling.change <= criterion.largest_change;
}

} // namespace keeler
