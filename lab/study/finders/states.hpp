// The four states of the paper's experiment: equal sizes or a power law, early (nearly uniform) or clumped by
// self-gravity. They are made once and stored as snapshots; a study always uses the stored particles, so that a
// continued study measures identical ones.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace keeler::study {

struct StudyState {
  std::string name; ///< equal-early, equal-clumped, power-early, power-clumped
  Scene scene;      ///< with self-gravity
  Patch patch;
  std::string made;           ///< how it was made, one sentence for the report
  double call_seconds = 0.02; ///< of calls that one measurement of the time per call averages over

  /// Returns the scene of a measurement: without gravity, with this step (orbits) and finder.
  Scene timed(double step_orbits, const std::string& finder) const;
};

/// Reads the four states from `folder` and makes the missing ones: `count` particles of equal size, half that number
/// with a size distribution. Throws Interrupted.
std::vector<StudyState> study_states(const std::filesystem::path& folder, std::size_t count,
                                     const std::function<void(const std::string&)>& say);

} // namespace keeler::study
