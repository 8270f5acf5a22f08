// Self-gravity as a force: a solver, its kick interval, and the origin from which it sees the patch.
#pragma once

#include <keeler/forces/force.hpp>
#include <keeler/gravity/solver.hpp>

#include <memory>
#include <vector>

namespace keeler::forces {
/// Return the keys of the scene's table [gravity], and the settings for their values.
/// The keys of the scene's table [gravity], and the settings that their values come to.
std::vector<Key> gravity_keys();
GravitySettings gravity_settings(const Parameters& parameters);
/// Returns a gravity solver's input at this boundary, in the order of the particles. Fills the two arrays, which must
/// outlive the problem, as the particles must.
/// outlive the problem, as the particles must.
gravity::GravityProblem gravity_problem(const Boundary& boundary, double orbital_frequency,
                                        std::vector<Vec3>& positions, std::vector<double>& masses);
/// Makes self-gravity. At each kick the solver sees the patch from another origin, drawn from the seed and the step:
/// particles fall differently on cells and meshes, so errors do not add up from kick to kick. In a periodic box nothing
/// else changes. Has no energy if only some rings of images act (has_energy_meter). Throws what make_gravity_solver
/// throws.
/// throws.
std::unique_ptr<Force> make_self_gravity(const GravitySettings& settings, const ForceContext& context);

} // namespace keeler::forces
