// Whether the physics depends on the solver or on the kick interval: runs of a small patch of Saturn's A ring with
// standing wakes, several seeds each, and the means of what one would publish.
#pragma once

#include "job_list.hpp"

#include <keeler/bench/gravity_choices.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// Ways to work out gravity, kick interval included: every solver at the same interval, then intervals with the tree.
std::vector<GravityChoice> gravity_run_choices();

/// "tree, opening_angle 0.6, a kick every 5 steps"
std::string run_label(const GravityChoice& choice);

/// Which run another one is compared with, by label; empty for those that others are compared with. Each solver is
/// held against direct, each interval against a kick every step.
std::vector<std::pair<std::string, std::string>> gravity_run_comparisons();

/// What is measured, by its name in a result, and as the report calls it.
struct RunQuantity {
  const char* name;
  const char* title;
};
const std::vector<RunQuantity>& run_quantities();

/// The state that all runs of a seed start from: evolved from a uniform patch for three eighths of `orbits`.
struct RunStart {
  Scene scene;
  Patch patch;
};
RunStart gravity_run_start(std::uint64_t seed, double orbits);

/// Particles there are in such a run.
std::size_t gravity_run_count();

/// Goes on for a quarter of `orbits`, so that runs forget the common start, then measures over `orbits`. The result has
/// the quantities (null where there are no wakes), solver, settings, kick_every, seed, and energy_residual: what the
/// energy budget leaves unexplained over what collisions took.
Json gravity_run(const RunStart& start, const GravityChoice& choice, double orbits);

/// Seconds that such a run takes, roughly.
double gravity_run_cost(const GravityChoice& choice, double orbits);

} // namespace keeler
