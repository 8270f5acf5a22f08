// The implementation of DriftPhase: what is kept from step to step, and the course of a step.
#pragma once

#include "broad_phase.hpp"
#include "candidate.hpp"
#include "contact_loop.hpp"
#include "optimistic_loop.hpp"
#include "sequential_orbits.hpp"
#include "step_context.hpp"
#include "step_history.hpp"
#include "step_outcome.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/collision/neighbour_audit.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/decomposition/ghost_layer.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace keeler::collision {

/// As DriftPhase, which forwards its calls. Never moved: the finder has a pointer to the step.
class DriftEngine {
public:
  DriftEngine(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency, double step);
  DriftEngine(const DriftEngine&) = delete;
  DriftEngine& operator=(const DriftEngine&) = delete;

  void collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally, bool undisturbed,
               const KickInterval& gravity);
  bool collide_distributed(Particles& particles, decomposition::GhostLayer& ghosts, const Communicator& ranks,
                           const ShearingBox& box, double offset, CollisionTally& tally, const KickInterval& gravity);
  DriftCosts costs() const;

  finders::Finder& finder() const {
    finders::Finder* const replacement = observer_ ? observer_->replacement_finder() : nullptr;
    return replacement ? *replacement : *finder_;
  }
  void release_contacts() {
    optimistic_.release();
    broad_phase_.lists().release_interval();
  }
  void release() { broad_phase_.lists().release(); }
  void set_step(double step, double kick_pull, double rest_pull);
  std::span<const SlowPair> slow_pairs() const { return outcome_.slow_pairs; }
  double kick_work() const { return outcome_.kick_work.value(); }
  void observe(DriftObserver* observer) { observer_ = observer; }
  void audit(NeighbourAudit* audit) { audit_ = audit; }
  double reached() const;

private:
  /// The length of steps (rad), and the pulls of StepContext.
  struct Schedule {
    double step, kick_pull = 0.0, rest_pull = 0.0;
  };

  StepContext context_of(Particles& particles, const ShearingBox& box, double offset,
                         const KickInterval& gravity) const;
  void begin_step(const StepContext& step, bool undisturbed);
  void find_candidates(const StepContext& step);
  std::vector<Event> solve(const StepContext& step, std::size_t own);
  bool carry_out_in_domains(const StepContext& step, const std::vector<Event>& first, const ContactCounter& counter);
  void count_contacts(const StepContext& step, const ContactCounter& counter);
  template<OrbitStore Orbits>
  void carry_out_in_sequence(const StepContext& step, std::span<const Event> first, Orbits& orbits);
  void end_step(const StepContext& step);
  std::size_t bytes(const StepContext& step) const;

  // for the run
  CollisionSettings settings_;
  Frequencies frequencies_;
  double orbital_frequency_;
  Schedule schedule_;
  std::unique_ptr<finders::Finder> finder_;
  DriftObserver* observer_ = nullptr;
  NeighbourAudit* audit_ = nullptr;
  DriftCosts costs_;

  // from step to step
  BroadPhase broad_phase_;
  OptimisticLoop optimistic_;
  finders::DriftStep finder_step_; // of the present step; the finder points to it

  // of the last step, in memory that the next one reuses
  StepHistory history_;
  StepOutcome outcome_;
  CandidateBlocks candidates_;
  EventQueue events_;
};

// Carries out all contacts that follow from the first ones.
template<OrbitStore Orbits>
void DriftEngine::carry_out_in_sequence(const StepContext& step, std::span<const Event> first, Orbits& orbits) {
  events_.assign(first);
  ContactLoop loop(step, orbits, events_);
  loop.run();
  costs_.widest_list = std::max(costs_.widest_list, loop.max_partners());
}

} // namespace keeler::collision
