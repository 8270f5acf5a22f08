// The four states of the paper's experiment: equal sizes or a power law, early (nearly uniform) or clumped by
// self-gravity. Made once, kept as snapshots, and always used as read back, so that a continued study sees the same.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace keeler {

struct StudyState {
  std::string name; ///< equal-early, equal-clumped, power-early, power-clumped
  Scene scene;      ///< with self-gravity
  Patch patch;
  std::string made; ///< how it came about, in words

  /// The scene of a measurement: no gravity, this step and finder.
  Scene timed(double step_orbits, const std::string& finder) const;
};

/// `count` particles of equal size, half as many with a size distribution. Throws Interrupted.
std::vector<StudyState> study_states(const std::filesystem::path& folder, std::size_t count,
                                     const std::function<void(const std::string&)>& say);

} // namespace keeler
