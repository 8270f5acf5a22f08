// What DriftPhase is made of: everything that is kept from step to step, and how a step goes.
#pragma once

#include "contact_loop.hpp"
#include "grid_partners.hpp"
#include "neighbours/neighbour_lists.hpp"
#include "optimistic_loop.hpp"

#include <keeler/collision/drift.hpp>
#include <keeler/collision/neighbour_audit.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/decomposition/ghost_layer.hpp>

namespace keeler {

/// As DriftPhase, which hands its calls on. Never moved: the finder has a pointer to the step.
class DriftEngine {
public:
  DriftEngine(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency, double step);
  DriftEngine(const DriftEngine&) = delete;
  DriftEngine& operator=(const DriftEngine&) = delete;

  void collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally, bool undisturbed);
  bool collide_distributed(Particles& particles, const GhostLayer& borders, const Communicator& ranks,
                           const ShearingBox& box, double offset, CollisionTally& tally);
  DriftCosts costs() const;

  Finder& finder() const {
    Finder* const stand_in = observer_ ? observer_->stand_in() : nullptr;
    return stand_in ? *stand_in : *finder_;
  }
  void release() { lists_.release(); }
  void set_pace(double step, double kick_pull, double rest_pull);
  std::span<const SlowPair> slow_pairs() const { return slow_pairs_; }
  void observe(DriftObserver* observer) { observer_ = observer; }
  void audit(NeighbourAudit* audit) { audit_ = audit; }
  double reached() const;

private:
  struct InPlace;
  struct Told;
  struct FollowsOwners;
  struct Sharing;
  /// Of a step that ranks share: how a particle began it that has been hit.
  struct Beginning {
    std::uint32_t place;
    Elements elements;
    Vec3 spin; ///< of a rough particle
  };
  /// The end of a particle's path and the begin of the next one.
  struct PathChange {
    std::uint32_t place;
    double time; ///< of the end
    Elements before, after;
    Vec3 spin_before, spin_after; ///< of a rough particle
  };
  /// Over the contacts of the step.
  struct Sums {
    ExactSum energy_lost, momentum_flux, azimuthal_gain;
  };
  /// A pair that may touch in the step: the lower id first, the image that of the higher.
  struct Candidate {
    std::uint32_t low, high;
    Image image;
  };

  void begin_step(Particles& particles, const ShearingBox& box, double offset, bool undisturbed);
  void carry_out(const std::vector<Event>& first, CollisionTally& tally);
  void end_step();
  void note_change(std::uint32_t place, double time, const Elements& after);
  void note_path(std::uint32_t place, const Elements& path);
  void note_changes_of_domains();
  void forget_changes();
  void complete_changes();
  void undo_changes();
  void do_again(Sharing& sharing);
  void end_distributed(Sharing& sharing, CollisionTally& tally);
  void gather_records(const Communicator& ranks);
  void prepare(bool undisturbed);
  bool in_domains(const std::vector<Event>& first, CollisionTally& tally);
  bool count(const Contact& contact, CollisionTally& tally);
  void add_sums(CollisionTally& tally) const;
  template<class Body> void for_each_block(const Body& body) const;
  void reject();
  void put_in_order(std::vector<Candidate>& candidates) const;
  std::vector<Event> solve();
  void audit_beginning();
  void audit_end();
  std::size_t bytes() const;

  CollisionSettings settings_;
  Frequencies frequencies_;
  double orbital_frequency_, step_;
  double kick_pull_ = 0.0, rest_pull_ = 0.0;
  std::unique_ptr<Finder> finder_;
  DriftObserver* observer_ = nullptr;
  NeighbourAudit* audit_ = nullptr;

  // the step at hand
  DriftObserver* watch_ = nullptr;         // the observer, when it looks on
  DriftObserver* takes_records_ = nullptr; // the observer, when it wants them
  std::vector<CollisionRecord> records_;   // for it
  Particles* particles_ = nullptr;         // only while it goes on
  StepAtHand step_at_hand_;
  DriftStep finder_step_;
  bool through_grid_ = false;
  NeighbourLists lists_;
  GridPartners grid_;
  std::vector<std::vector<Candidate>> candidates_;
  EventQueue events_;
  OptimisticLoop optimistic_;
  StepSoFar so_far_;
  std::vector<std::uint32_t> touched_; // who has been hit in the step, once each
  std::vector<SlowPair> slow_pairs_;   // that have touched in the step
  std::uint64_t gave_up_ = 0;
  Sums sums_;
  static constexpr std::size_t everybody = ~std::size_t{0};
  std::size_t counted_ = everybody; // particles, the first ones, whose contacts count here
  // of a step that ranks share
  const GhostLayer* borders_ = nullptr; // none otherwise
  std::vector<Beginning> beginnings_;   // once each
  std::vector<PathChange> changes_;     // of particles that two ranks have
  bool strayed_ = false;                // an own particle, from where the borders are good
  DriftCosts costs_;
};

} // namespace keeler
