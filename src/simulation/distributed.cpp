// Distributed runs: docs/dev/ranks.md.
#include <keeler/simulation/simulation.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/decomposition/blocks.hpp>
#include <keeler/finders/finders.hpp>

#include <fmt/format.h>

namespace keeler::simulation {

namespace {

const char* solver_words(GravitySettings::Solver solver) {
  using enum GravitySettings::Solver;
  return solver == direct ? "gravity by direct sums" : solver == tree ? "gravity by the tree" : "axisymmetric gravity";
}

} // namespace

// Refuses what still needs an order, an index or a network of all particles.
void Simulation::require_distributable(const Scene& scene, std::size_t count) {
  const auto refuse = [](const char* what, const char* instead) {
    throw UsageError(fmt::format("{} cannot be distributed over ranks; {}, or run on one rank", what, instead));
  };
  if (scene.gravity) {
    const GravitySettings gravity = chosen_for(count, *scene.gravity);
    if (gravity.solver != GravitySettings::Solver::fft && gravity.solver != GravitySettings::Solver::mesh)
      refuse(solver_words(gravity.solver), "set gravity.solver to \"fft\" (of bench: --solver fft)");
    if (gravity.carries())
      refuse("contacts at rest that carry kicks", "set gravity.resting_contacts to \"bounced\"");
  }
  if (!finders::make_finder(scene.collisions.finder)->exact())
    refuse("an inexact finder", "set collisions.finder to \"certified\"");
}

void Simulation::divide() {
  if (!ranks_.distributed())
    return;
  ranks_.together([&] { require_distributable(scene_, count_); });
  blocks_ = std::make_unique<decomposition::Blocks>(ranks_, state_.box, scene_.planet.frequencies);
  blocks_->distribute(holding());
}

// Returns the particles, and the accelerations of their last kicks, which the next half kick needs.
decomposition::Holding Simulation::holding() {
  decomposition::Holding holding{state_.particles, {}};
  for (ForceState& force : state_.forces)
    holding.rows.push_back(&force.accelerations);
  return holding;
}

// Makes sure that the ghost layer is valid for the next step.
void Simulation::require_ghost_layer() {
  const decomposition::Epoch epoch{0.5 * state_.tick() * static_cast<double>(2 * state_.step + state_.control.step),
                                   state_.epoch_offset(), state_.step_length};
  if (blocks_->is_valid(state_.particles, epoch))
    return;
  drift_.release();
  blocks_->rebuild(holding(), epoch);
  find_moonlets();
}

// Every particle that may touch one of this rank's in the next step has a copy here, and that step begins at this
// boundary.
cells::Overlap Simulation::largest_overlap_distributed() {
  require_ghost_layer();
  blocks_->add_ghosts(state_.particles);
  const cells::Overlap here = cells::largest_overlap(patch_of(state_.particles));
  blocks_->remove_ghosts(state_.particles);
  cells::Overlap largest;
  for (const std::vector<cells::Overlap>& of_rank : ranks_.exchange(std::vector(ranks_.size(), std::vector{here})))
    if (deeper(of_rank.front(), largest))
      largest = of_rank.front();
  return largest;
}

void Simulation::collide_distributed() {
  const double offset = state_.epoch_offset();
  for (;;) {
    require_ghost_layer();
    blocks_->add_ghosts(state_.particles);
    if (scene_.gravity)
      blocks_->add_ghosts(state_.forces.front().accelerations);
    const bool done = drift_.collide_distributed(state_.particles, blocks_->ghosts(), ranks_, state_.box, offset,
                                                 state_.collisions, kicks_of_drift());
    blocks_->remove_ghosts(state_.particles);
    if (scene_.gravity)
      blocks_->remove_ghosts(state_.forces.front().accelerations);
    if (done)
      return;
    blocks_->widen();
  }
}

} // namespace keeler::simulation
