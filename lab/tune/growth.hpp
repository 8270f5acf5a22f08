// The state that a scene evolves to, and the cost of the evolution.
#pragma once

#include <keeler/core/phase_progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler::tune {

struct GrownScene {
  Scene scene;                 ///< with the settings that depend on the initial state filled in
  std::vector<Patch> states;   ///< several of the last orbit, since wakes of a small box fluctuate; the last at its end
  double orbits = 0.0;         ///< age of the last state
  double contact_rate = 0.0;   ///< contacts per particle and orbit, in the last orbit
  double seconds = 0.0;        ///< of the evolution; processor time on one thread, wall time on several
  double seconds_at_end = 0.0; ///< per orbit, over the last orbit
};

/// Evolves the scene's initial state on all threads, with an automatic step and the cheapest suitable solver.
/// Precondition: `orbits` > 0.
GrownScene grow(const Scene& scene, double orbits, PhaseProgress& progress);

} // namespace keeler::tune
