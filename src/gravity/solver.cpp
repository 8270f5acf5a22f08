#include <keeler/gravity/solver.hpp>

#include "tree.hpp"

#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/gravity/direct.hpp>
#include <keeler/gravity/fft.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::gravity {
namespace {

using Solver = GravitySettings::Solver;

constexpr std::size_t max_direct = 64; // particles: up to here direct sums are cheapest

bool pairwise(const GravitySettings& settings) {
  return settings.solver == Solver::direct || settings.solver == Solver::tree;
}

std::unique_ptr<FftSolver> make_fft(const GravitySettings& settings, std::span<const double> masses, double area,
                                    const Communicator& ranks) {
  assert(area > 0.0);
  const std::size_t count = ranks.sum(masses.size());
  const double distance = std::sqrt(area / static_cast<double>(std::max<std::size_t>(count, 1)));
  const double cut =
      settings.mesh_cut > 0.0 ? settings.mesh_cut : cut_for(settings.force_error, mass_spread(masses, ranks));
  return std::make_unique<FftSolver>(FftSettings{settings.mesh_spacing * distance, cut, settings.solver == Solver::fft},
                                     choose_instruction_set());
}

} // namespace

GravitySettings chosen_for(std::size_t count, GravitySettings settings) {
  if (settings.solver != Solver::automatic)
    return settings;
  settings.solver = count <= max_direct ? Solver::direct : Solver::fft;
  settings.images.rings = 2; // direct: the error of one ring is up to 3e-5
  return settings;
}

std::unique_ptr<GravitySolver> make_gravity_solver(const GravitySettings& settings, std::span<const double> masses,
                                                   double area, const Communicator& ranks) {
  const InstructionSet set = choose_instruction_set();
  const GravitySettings chosen = chosen_for(ranks.sum(masses.size()), settings);
  if (chosen.solver == Solver::direct)
    return std::make_unique<DirectSolver>(chosen.images, set);
  if (chosen.solver == Solver::tree)
    return std::make_unique<TreeSolver>(chosen.opening_angle, chosen.images, set);
  if (chosen.solver == Solver::axisymmetric)
    return std::make_unique<AxisymmetricSolver>(chosen.shortest_wavelength);
  return make_fft(chosen, masses, area, ranks);
}

bool has_energy_meter(const GravitySettings& settings) {
  return !pairwise(settings) || settings.images.far;
}

std::unique_ptr<EnergyMeter> make_energy_meter(const GravitySettings& settings, std::span<const double> masses,
                                               double area, const Communicator& ranks) {
  if (!has_energy_meter(settings))
    return nullptr;
  if (settings.solver == Solver::axisymmetric)
    return std::make_unique<AxisymmetricSolver>(settings.shortest_wavelength);
  GravitySettings chosen = settings;
  if (pairwise(settings))
    chosen = {};
  if (settings.solver != Solver::mesh)
    chosen.solver = Solver::fft;
  return make_fft(chosen, masses, area, ranks);
}

} // namespace keeler::gravity
