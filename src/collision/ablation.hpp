// Accelerations of the drift that a build with KEELER_ABLATION can switch off, to measure the gain of each:
// scripts/ablation. In any other build all are compile-time constants.
#pragma once

#ifdef KEELER_ABLATION
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#endif

namespace keeler::collision {

enum class Acceleration {
  lists,         ///< neighbour lists that last more than a step
  mending,       ///< rebuild of single lists, of particles that leave their skin
  windows,       ///< pruned pairs that last more than a step
  simd,          ///< kernels for straight lines
  rejection,     ///< straight-line tests before the finder
  newton,        ///< monotone Newton's method before the certified search
  lanes,         ///< several pairs at a time in Newton's method
  levels,        ///< levels of cells
  groups,        ///< groups of lines in the making of lists
  presorting,    ///< sorting of the events known when a step begins
  repredictions, ///< re-prediction events of large bodies
  count_
};

#ifdef KEELER_ABLATION

/// The accelerations that the environment variable KEELER_WITHOUT names, separated by commas.
class LeftOut {
public:
  LeftOut() {
    constexpr const char* names[] = {"lists", "mending", "windows", "simd",       "rejection", "newton",
                                     "lanes", "levels",  "groups",  "presorting", "looks"};
    static_assert(std::size(names) == static_cast<std::size_t>(Acceleration::count_));
    const char* const variable = std::getenv("KEELER_WITHOUT");
    std::istringstream all(variable ? variable : "");
    for (std::string name; std::getline(all, name, ',');) {
      bool known = false;
      for (std::size_t k = 0; k < std::size(names); ++k)
        if (name == names[k])
          known = is_out_[k] = true;
      if (!known) {
        std::fprintf(stderr, "KEELER_WITHOUT: there is no acceleration '%s'\n", name.c_str());
        std::exit(2);
      }
    }
  }
  bool operator[](Acceleration which) const { return is_out_[static_cast<std::size_t>(which)]; }

private:
  bool is_out_[static_cast<std::size_t>(Acceleration::count_)] = {};
};
inline const LeftOut left_out;
inline bool without(Acceleration which) {
  return left_out[which];
}

#else

/// True if the acceleration is switched off.
constexpr bool without(Acceleration) {
  return false;
}

#endif

} // namespace keeler::collision
