// Accelerations of the drift that a build with KEELER_ABLATION can do without, so that what each gains can be measured:
// scripts/ablation. Any other build has all of them, and no trace of the question.
#pragma once

#ifdef KEELER_ABLATION
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#endif

namespace keeler {

enum class Acceleration {
  lists,      ///< neighbour lists live for more than a step
  mending,    ///< who leaves its slack is listed anew alone
  windows,    ///< near pairs serve for more than a step
  simd,       ///< of the straight lines' tests
  rejection,  ///< by straight lines, before the finder
  newton,     ///< monotone, before the certified search
  lanes,      ///< several pairs at a time in Newton's method
  levels,     ///< of cells
  groups,     ///< lines look around together when lists are made
  presorting, ///< of the events known when a step begins
  prefetching,
  looks, ///< re-prediction events of large bodies
  count_
};

#ifdef KEELER_ABLATION

/// Those that the environment variable KEELER_WITHOUT names, with commas between.
class LeftOut {
public:
  LeftOut() {
    constexpr const char* names[] = {"lists", "mending", "windows", "simd",       "rejection",   "newton",
                                     "lanes", "levels",  "groups",  "presorting", "prefetching", "looks"};
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

/// Whether to do without it.
constexpr bool without(Acceleration) {
  return false;
}

#endif

} // namespace keeler
