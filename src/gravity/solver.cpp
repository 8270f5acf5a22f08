#include <keeler/gravity/solver.hpp>

#include <keeler/gravity/direct.hpp>
#include <keeler/gravity/tree.hpp>

namespace keeler {

std::unique_ptr<GravitySolver> make_gravity_solver(const GravitySettings& settings) {
  const InstructionSet set = choose_instruction_set();
  if (settings.solver == GravitySettings::Solver::direct)
    return std::make_unique<DirectSolver>(settings.images, set);
  return std::make_unique<TreeSolver>(settings.opening_angle, settings.images, set);
}

} // namespace keeler
