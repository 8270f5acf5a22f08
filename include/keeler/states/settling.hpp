// When the wakes of a patch have settled. Their amplitude (Wakes::amplitude, diagnostics/wakes.hpp) grows for about two
// orbits, overshoots, and then wanders for ever, by half its value within an orbit, because a box holds few wakes,
// which form and dissolve. So means over one orbit are compared: wakes have settled when the mean over the last orbit
// differs from the mean over the orbit before it by no more than such means differ for ever, and the state is taken at
// a moment when the amplitude is near that mean, so that it is a typical one.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace keeler {

/// docs/dev/diagnostics.md has the runs from which these numbers were chosen.
struct SettleCriterion {
  double samples_per_orbit = 16.0;
  double window_orbits = 1.0;      ///< length of a mean
  double largest_change = 0.15;    ///< between two means, of the later one
  double largest_deviation = 0.25; ///< of the last sample from the mean, of the mean
  double most_orbits = 10.0;       ///< not settled by then: never
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
  double deviation = 0.0; ///< |last sample − amplitude| / amplitude; likewise
  bool standing = false;  ///< in every sample of the last window
};

/// Compares the last `window` samples with as many before them; none as long as there are fewer than two windows.
std::optional<Settling> compare_windows(std::span<const WakeSample> history, std::size_t window);

/// There are wakes, they change no more, and the last sample is typical of them.
inline bool settled(const Settling& settling, const SettleCriterion& criterion) {
  return settling.standing && settling.change <= criterion.largest_change &&
         settling.deviation <= criterion.largest_deviation;
}

} // namespace keeler
