// The gravity solvers with all settings that benches and studies sweep: the one list of them.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace keeler {

/// A solver with settings, and how they are called.
struct GravityChoice {
  std::string solver;    ///< as GravitySolver::name() and a scene have it
  std::string text;      ///< of the settings
  std::string parameter; ///< what the solver's error converges with, "opening angle"; empty: with nothing
  double value = 0.0;    ///< of that parameter
  GravitySettings settings;
};

/// Solver by solver, the most accurate settings first. `dense`: as many settings as a curve needs.
std::vector<GravityChoice> gravity_choices(bool dense);

/// The solvers in that list.
std::vector<std::string> gravity_solver_names();

/// The choice of a solver by name, with what a scene that names it gets by default. The name must be in the list.
GravityChoice default_gravity_choice(const std::string& solver);

/// What these settings are called; `automatic` is what it stands for with so many particles.
GravityChoice choice_of(const GravitySettings& settings, std::size_t count);

} // namespace keeler
