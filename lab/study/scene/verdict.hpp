// The cheapest acceptable setting of a study, and the smallest differences that the study could detect.
#pragma once

#include "results.hpp"

#include <optional>
#include <string>
#include <vector>

namespace keeler::study {

/// Tolerated relative difference of the loss over stress (1 in a steady state) from the reference.
inline constexpr double balance_tolerance = 0.02;

/// Comparison of a setting with the reference. "Within" means that the runs show no difference, not that there is none.
struct SettingVerdict {
  std::optional<double> balance_off, balance_bound; ///< relative to the reference; none: not measured
  std::vector<std::string> beyond;                  ///< titles of the numbers that differ by more than the scatter
  bool compared = false;                            ///< true if at least one number has a known difference

  /// True if the mean balance differs by at most the tolerance and no other number by more than the scatter.
  bool acceptable() const;
  /// True if the whole interval of the balance's difference is within the tolerance.
  bool balance_shown() const;
};

/// Compares one setting with the reference. Precondition: `setting` is an index of means.settings.
SettingVerdict verdict_on(const StudyMeans& means, std::size_t setting);

/// Returns the acceptable setting, or the reference, with the smallest processor time; none when no time is known.
std::optional<std::size_t> cheapest_acceptable(const StudyMeans& means);

/// Returns the verdict as a paragraph.
std::string verdict_text(const StudyMeans& means);

/// Returns a paragraph with the smallest detectable difference of each number, in per cent of the reference; empty when
/// none is known.
std::string sensitivity_text(const StudyMeans& means);

} // namespace keeler::study
