// Runs that test whether the physics depends on the gravity solver or on the kick interval: a small patch of Saturn's A
// ring with wakes, several seeds each, and the means of the quantities that papers publish.
#pragma once

#include "job_list.hpp"

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// Returns the compared settings: every solver at one kick interval, then the tree at the other intervals.
std::vector<GravityChoice> gravity_run_choices();

/// Returns a name such as "tree, opening_angle 0.6, a kick every 5 steps".
std::string run_label(const GravityChoice& choice);

/// Returns the compared pairs of labels (run, reference): each solver with direct, each kick interval with a kick every
/// step.
std::vector<std::pair<std::string, std::string>> gravity_run_comparisons();

/// A measured quantity.
struct RunQuantity {
  const char* name;  ///< key in a result
  const char* title; ///< in the report
};
const std::vector<RunQuantity>& run_quantities();

/// The common state of all runs of a seed: a uniform patch, evolved for three eighths of `orbits`.
struct RunStart {
  Scene scene;
  Patch patch;
};
RunStart gravity_run_start(std::uint64_t seed, double orbits);

/// Returns the number of particles in such a run.
std::size_t gravity_run_count();

/// Evolves `start` for a quarter of `orbits`, so that runs forget the common state, then measures over `orbits`. The
/// result has the quantities (null without wakes), solver, settings, kick_every, seed, and energy_residual: the
/// unexplained part of the energy budget over the energy lost in collisions. Precondition: `orbits` > 0.
Json gravity_run(const RunStart& start, const GravityChoice& choice, double orbits);

/// Estimates the duration of such a run, s.
double gravity_run_cost(const GravityChoice& choice, double orbits);

} // namespace keeler
