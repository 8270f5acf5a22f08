#include "step_check.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::runs {
namespace {

void require(const char* invariant, const std::string& fault) {
  if (!fault.empty())
    throw InvariantError(fmt::format("{}: {}", invariant, fault));
}

} // namespace

StepCheck::StepCheck(const Scene& scene, Simulation& simulation) : scene_(scene), simulation_(simulation) {
  simulation_.drift().audit(&audit_);
}

StepCheck::~StepCheck() {
  simulation_.drift().audit(nullptr);
}

void StepCheck::end() const {
  assert(before_ && before_->state.step < simulation_.state().step);
  const simulation::SimulationState& now = simulation_.state();
  const Frequencies& f = scene_.planet.frequencies;
  const bool kicked = !now.forces.empty() && now.step % before_->kick_ticks.front() == 0;
  require("finite numbers", fault_of_numbers(now));
  require("the same particles", fault_of_particles(before_->state, now));
  require("complete neighbours", fault_of_neighbours(audit_));
  require("no overlap", fault_of_overlap(simulation_.patch()));
  require("conserved sums", fault_of_sums(*before_, now, f));
  require("energy", fault_of_energy(*before_, now, simulation_.means(), f));
  if (scene_.gravity && kicked)
    require("forces", fault_of_forces(scene_, simulation_.boundary(), now));
}

} // namespace keeler::runs
