// Distributed runs: docs/dev/ranks.md.
#include <keeler/simulation/simulation.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/decomposition/blocks.hpp>

namespace keeler::simulation {

void Simulation::divide() {
  if (!ranks_.distributed())
    return;
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
  own_by_id_.clear();
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
  const auto remove_ghosts = [&] {
    blocks_->remove_ghosts(state_.particles);
    if (scene_.gravity)
      blocks_->remove_ghosts(state_.forces.front().accelerations);
  };
  for (;;) {
    require_ghost_layer();
    blocks_->add_ghosts(state_.particles);
    if (scene_.gravity)
      blocks_->add_ghosts(state_.forces.front().accelerations);
    mark_at_rest();
    bool done = false;
    try {
      done = drift_.collide_distributed(state_.particles, blocks_->ghosts(), ranks_, state_.box, offset,
                                        state_.collisions, kicks_of_drift());
    } catch (...) {
      remove_ghosts(); // the state may be saved
      throw;
    }
    if (done)
      note_slow_pairs();
    remove_ghosts();
    if (done)
      return;
    blocks_->widen();
  }
}

} // namespace keeler::simulation
