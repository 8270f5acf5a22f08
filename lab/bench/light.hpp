// Times the ray tracer on the spheres of a patch: paths of sunlight, single rays, and Embree's own queries beside them.
#pragma once

#include <keeler/core/progress.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace keeler::bench {

struct LightBenchSettings {
  std::size_t count = 100000;      ///< rounded to whole tiles
  std::string state = "settled";   ///< one of gravity_state_names()
  std::optional<std::string> from; ///< a snapshot to trace; `count` and `state` are then ignored
  double elevation = 20.0;         ///< of observer and Sun, degrees, above 0; the phase angle is 6°
  int repeats = 5;
  std::function<void(const Progress&)> progress; ///< may be empty
};

/// Speeds are medians over the repeats, in rays per second and thread.
struct LightBench {
  std::size_t count = 0;                 ///< spheres
  double preparation_s = 0.0;            ///< wall time to make or read the state
  double scene_s = 0.0;                  ///< wall time to build Embree's scene
  double paths_per_s = 0.0;              ///< rays with all their orders of scattering
  double spheres_met = 0.0;              ///< by a path, mean
  double first_hits_per_s = 0.0;         ///< first sphere on a ray
  double any_hits_per_s = 0.0;           ///< any sphere on a ray
  double embree_rays_per_s = 0.0;        ///< any sphere, Embree's query of single rays that begin side by side
  double embree_packet_rays_per_s = 0.0; ///< the same in packets of 16
  double one_percent_s = 0.0;            ///< wall time of an I/F with a standard error of 1 %, all threads
  std::uint64_t one_percent_rays = 0;
};

/// Makes or reads the state and times it. Precondition: count and repeats are positive. Throws Error without Embree,
/// and what read_snapshot() throws.
LightBench bench_light(const LightBenchSettings& settings);

} // namespace keeler::bench
