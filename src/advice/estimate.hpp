// Estimates the cost of a run: processor seconds by part, from the scene and the speed of this machine, by measured
// contact rates and times. docs/dev/estimate.md lists them, and the accuracy of the estimate.
#pragma once

#include <keeler/scene/scene.hpp>

#include <array>
#include <string>
#include <vector>

namespace keeler::advice {

/// Processor time, s.
struct RunEstimate {
  double start = 0.0;   ///< making the initial state
  double drift = 0.0;   ///< moving particles, finding and resolving contacts
  double gravity = 0.0; ///< solves and kicks
  double output = 0.0;  ///< files, rows of the series, checks, and the summary

  double total() const { return start + drift + gravity + output; }

  struct Part {
    const char* name;
    double seconds;
  };
  std::array<Part, 4> parts() const;
  const char* dominating() const; ///< name of the largest part
};

/// bench's `pair_ns` on the machine on which the times were measured.
inline constexpr double reference_pair_ns = 6.55;

/// Estimates a run on a machine with pair yardstick `pair_ns`. Precondition: the scene has no start file; pair_ns >
/// 0.
RunEstimate estimate_run(const Scene& scene, double pair_ns = reference_pair_ns);

/// Returns a line, with advice, for each setting that alone makes the run cost several times more. Precondition: the
/// scene has no start file.
std::vector<std::string> expensive_settings(const Scene& scene);

} // namespace keeler::advice
