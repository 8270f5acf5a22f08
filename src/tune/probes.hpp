// Short runs from the states of a growth: what a kick interval makes, what a step costs, what threads gain.
#pragma once

#include <keeler/core/phase_progress.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/tune/tune.hpp>

#include <vector>

namespace keeler {

/// The scene with another step and kick interval, which without self-gravity is the step.
Scene with_steps(Scene scene, double step, int drifts);

/// A fifth of an orbit from each state; where contacts are few, up to the longest time, orbits.
KickProbe probe_kicks(const Scene& scene, const std::vector<Patch>& states, double interval, int drifts,
                      double longest);

/// Of the kick interval divided into so many drifts each, in turns, from each state.
std::vector<StepProbe> probe_steps(const Scene& scene, const std::vector<Patch>& states, double interval,
                                   const std::vector<int>& drifts, PhaseProgress& progress);

/// On 1, 2, 4 … threads and the most.
std::vector<ThreadProbe> probe_threads(const Scene& scene, const Patch& patch, int most, PhaseProgress& progress);

} // namespace keeler
