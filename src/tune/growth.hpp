// The state that a scene comes to, and what it costs to get there.
#pragma once

#include <keeler/core/phase_progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler {

struct GrownScene {
  Scene scene;                 ///< with what its start decides
  std::vector<Patch> states;   ///< of its last orbit, the last one at its end: in a small box wakes come and go
  double orbits = 0.0;         ///< its age
  double contact_rate = 0.0;   ///< of a particle, in the last orbit
  double seconds = 0.0;        ///< all of it; processor time on one thread, wall time on several
  double seconds_at_end = 0.0; ///< an orbit, over the last one
};

/// Evolves the scene's start on all threads, with an automatic step and the cheapest solver that is of use.
GrownScene grow(const Scene& scene, double orbits, PhaseProgress& progress);

} // namespace keeler
