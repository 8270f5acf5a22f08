// Numbers that follow from a scene, as `keeler check` prints them. SI units.
#pragma once

#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <string>

namespace keeler::advice {

struct Derived {
  /// False if a start file holds the particles: then only the steps are known, and the other numbers are 0.
  bool particles_known = false;
  std::size_t particle_count = 0;
  double optical_depth = 0.0;
  double surface_density = 0.0; ///< kg/m²
  double lambda_cr = 0.0;       ///< m
  double toomre_q = 0.0;        ///< at the start
  double hill_parameter = 0.0;
  double midplane_filling = 0.0; ///< at the start, maximum over the box; at most largest_filling
  std::int64_t steps = 0;
  double memory_mb = 0.0; ///< estimated peak memory, 10⁶ bytes
};

Derived derive(const Scene& scene);

/// Returns the estimated peak memory, without the program, of a process that owns `own` of `all` particles of a run in
/// a patch like the scene's, bytes. One process owns all.
double rank_memory(const Scene& scene, std::size_t own, std::size_t all);

/// Throws UsageError if that is more than is available.
void require_memory_for(const Scene& scene, std::size_t own, std::size_t all);

/// The same for `count` particles on one process.
inline void require_memory_for(const Scene& scene, std::size_t count) {
  require_memory_for(scene, count, count);
}

/// Returns a description of the solver: "tree, opening angle 0.6".
std::string in_words(const GravitySettings& gravity);

} // namespace keeler::advice
