#include <keeler/gravity/solver.hpp>

#include "tree.hpp"

#include <keeler/gravity/direct.hpp>
#include <keeler/gravity/fft.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

using Solver = GravitySettings::Solver;

constexpr std::size_t few = 64; // particles: direct sums are cheapest

} // namespace

GravitySettings chosen_for(std::size_t count, GravitySettings settings) {
  if (settings.solver != Solver::automatic)
    return settings;
  settings.solver = count <= few ? Solver::direct : Solver::fft;
  settings.images.rings = 2; // direct: one ring errs by up to 3e-5
  return settings;
}

std::unique_ptr<GravitySolver> make_gravity_solver(const GravitySettings& settings, std::span<const double> masses,
                                                   double area) {
  const InstructionSet set = choose_instruction_set();
  const GravitySettings chosen = chosen_for(masses.size(), settings);
  if (chosen.solver == Solver::direct)
    return std::make_unique<DirectSolver>(chosen.images, set);
  if (chosen.solver == Solver::tree)
    return std::make_unique<TreeSolver>(chosen.opening_angle, chosen.images, set);
  const double distance = std::sqrt(area / static_cast<double>(std::max<std::size_t>(masses.size(), 1)));
  const double cut = chosen.mesh_cut > 0.0 ? chosen.mesh_cut : cut_for(chosen.force_error, mass_spread(masses));
  return std::make_unique<FftSolver>(FftSettings{chosen.mesh_spacing * distance, cut, chosen.solver == Solver::fft},
                                     set);
}

} // namespace keeler
