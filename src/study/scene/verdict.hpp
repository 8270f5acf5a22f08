// Which setting of a study is good enough, and what the study could not have seen.
#pragma once

#include "results.hpp"

#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// How far the loss over the stress, which is 1, may be from the reference's: 2 %.
inline constexpr double balance_tolerance = 0.02;

/// A setting against the reference. "Within" means that the runs do not show a difference, not that there is none.
struct SettingVerdict {
  std::optional<double> balance_off, balance_bound; ///< over the reference's; none: not measured
  std::vector<std::string> beyond;                  ///< titles of the numbers that differ by more than the scatter
  bool compared = false;                            ///< at least one number of both has a scatter

  /// The balance differs by at most the tolerance, as far as its mean tells, and nothing else by more than the scatter.
  bool acceptable() const;
  /// The balance differs by at most the tolerance even at the end of its interval.
  bool balance_shown() const;
};

SettingVerdict verdict_on(const StudyMeans& means, std::size_t setting);

/// The acceptable setting with the least processor time, the reference among them; none when no time is known.
std::optional<std::size_t> cheapest_acceptable(const StudyMeans& means);

/// The verdict in words, a sentence after the other.
std::string verdict_text(const StudyMeans& means);

/// The largest difference that could have escaped, a number each, in per cent of the reference; empty: nothing known.
std::string sensitivity_text(const StudyMeans& means);

} // namespace keeler
