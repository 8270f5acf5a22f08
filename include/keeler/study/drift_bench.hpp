// What a step of the drift phase costs: equal spheres without gravity, in collisional equilibrium at ε = 0.5.
#pragma once

#include <cstddef>
#include <string>

namespace keeler {

struct DriftBenchSettings {
  std::size_t count = 10000;
  double step_orbits = 1e-3;
  double optical_depth = 0.5;
  std::string finder = "certified";
  int repeats = 5;
  bool all_pairs = false; ///< every grid candidate goes to the finder
};

/// Medians over the repeats. Times are processor time on one thread, wall time on several.
struct DriftBench {
  double ns_per_particle_step = 0.0;
  double ns_per_call = 0.0; ///< of the finder, on the pairs that the first step hands to it; one thread
  double calls_per_particle_step = 0.0;
  double collisions_per_particle_orbit = 0.0; ///< faster than v_cut
  double dispersion_r_omega = 0.0;            ///< c_x of the state that is timed
  int steps = 0;                              ///< timed in each repeat
};

/// The state is a uniform patch near its equilibrium, evolved for one and a half orbits; every repeat starts from it
/// anew. Throws UsageError for an unknown finder or an impossible patch.
DriftBench bench_drift(const DriftBenchSettings& settings);

} // namespace keeler
