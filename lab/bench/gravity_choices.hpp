// The only lists of the gravity solvers, settings and states that benches choose from.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace keeler::bench {

/// A solver with settings, and their names in tables.
struct GravityChoice {
  std::string solver; ///< name as in GravitySolver::name() and scenes
  std::string text;   ///< the settings, "opening_angle 0.6"
  GravitySettings settings;
};

/// Returns the choices by solver, the most accurate settings first.
std::vector<GravityChoice> gravity_choices();

/// Returns the names of the solvers in that list.
std::vector<std::string> gravity_solver_names();

/// Returns the names of the states (gravity_states.hpp), the default first.
std::vector<std::string> gravity_state_names();

/// Returns a solver with the default settings of a scene. Throws std::invalid_argument for a name not in the list.
GravityChoice default_gravity_choice(const std::string& solver);

/// Returns the choice with these settings; `automatic` is resolved for `count` particles.
GravityChoice choice_of(const GravitySettings& settings, std::size_t count);

} // namespace keeler::bench
