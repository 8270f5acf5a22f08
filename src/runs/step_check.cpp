#include "step_check.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::runs {

StepCheck::StepCheck(const Scene& scene, Simulation& simulation) : scene_(scene), simulation_(simulation) {
  simulation_.drift().audit(&audit_);
}

StepCheck::~StepCheck() {
  simulation_.drift().audit(nullptr);
}

// Throws on all ranks if a rank found a fault. Collective.
void StepCheck::require(const char* invariant, const std::string& fault) const {
  simulation_.ranks().together([&] {
    if (!fault.empty())
      throw InvariantError(fmt::format("{}: {}", invariant, fault));
  });
}

void StepCheck::end() {
  assert(before_ && before_->state.step < simulation_.state().step);
  const simulation::SimulationState& now = simulation_.state();
  const Communicator& ranks = simulation_.ranks();
  const Frequencies& f = scene_.planet.frequencies;
  const bool kicked = !now.forces.empty() && now.step % before_->kick_ticks.front() == 0;
  require("finite numbers", fault_of_numbers(now));
  std::optional<simulation::SimulationState> dealt;
  if (ranks.distributed()) { // particles may have other owners than before
    before_->state = dealt_by_id(before_->state, ranks);
    dealt = dealt_by_id(now, ranks);
  }
  const simulation::SimulationState& compared = dealt ? *dealt : now;
  require("the same particles", fault_of_particles(before_->state, compared));
  require("complete neighbours", fault_of_neighbours(audit_));
  require("no overlap", fault_of_overlap(simulation_.deepest_overlap()));
  require("conserved sums", fault_of_sums(*before_, compared, f, ranks));
  require("energy", fault_of_energy(*before_, now, simulation_.means(), f));
  if (scene_.gravity && kicked)
    require("forces", fault_of_forces(scene_, simulation_.boundary(), now));
}

} // namespace keeler::runs
