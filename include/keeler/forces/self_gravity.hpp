// Self-gravity as a force: a solver, how often it kicks, and from where it sees the patch.
#pragma once

#include <keeler/forces/force.hpp>
#include <keeler/gravity/solver.hpp>

#include <memory>
#include <vector>

namespace keeler {

/// The keys of the scene's table [gravity], and the settings that their values come to.
std::vector<Key> gravity_keys();
GravitySettings gravity_settings(const Parameters& parameters);

/// What a gravity solver is asked at this boundary, in the order of the particles. The two arrays are filled, and must
/// outlive the problem, as the particles must.
GravityProblem gravity_problem(const Boundary& boundary, double orbital_frequency, std::vector<Vec3>& positions,
                               std::vector<double>& masses);

/// The solver sees the patch from another origin at each kick, drawn from the seed and the step: where cells and meshes
/// fall among the particles changes, and their errors do not add up from kick to kick. In a periodic box nothing else
/// changes. It has no energy where only some rings of images act (has_energy_meter). Throws what make_gravity_solver
/// throws.
std::unique_ptr<Force> make_self_gravity(const GravitySettings& settings, const ForceContext& context);

} // namespace keeler
