// Short runs from evolved states that measure the effect of a kick interval, the cost of a step, and the speedup by
// threads.
#pragma once

#include <keeler/core/phase_progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/tune/tune.hpp>

#include <vector>

namespace keeler::tune {

/// Returns the scene with this step (orbits), and with self-gravity a kick every `drifts` steps.
/// Precondition: both are positive.
Scene with_steps(Scene scene, double step, int drifts);

/// Counts unresolved contacts with this kick interval (orbits) over a fifth of an orbit from each state, or over up to
/// `max_orbits` when contacts are few. Precondition: `states` is not empty.
KickProbe probe_kicks(const Scene& scene, const std::vector<Patch>& states, double interval, int drifts,
                      double max_orbits);

/// Times the kick interval with each of these numbers of drifts, in turn, from each state.
/// Precondition: `states` and `drifts` are not empty.
std::vector<StepProbe> probe_steps(const Scene& scene, const std::vector<Patch>& states, double interval,
                                   const std::vector<int>& drifts, PhaseProgress& progress);

/// Measures the speedup on 1, 2, 4 … and `thread_limit` threads.
std::vector<ThreadProbe> probe_threads(const Scene& scene, const Patch& patch, int thread_limit,
                                       PhaseProgress& progress);

} // namespace keeler::tune
