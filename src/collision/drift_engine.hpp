// What DriftPhase is made of: everything that is kept from step to step, and how a step goes.
#pragma once

#include "crowd.hpp"
#include "grid_partners.hpp"
#include "strips.hpp"

#include <keeler/collision/drift.hpp>

namespace keeler {

/// As DriftPhase, which hands its calls on. Never moved: the finder has a pointer to the step.
class DriftEngine {
public:
  DriftEngine(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency, double step);
  DriftEngine(const DriftEngine&) = delete;
  DriftEngine& operator=(const DriftEngine&) = delete;

  void collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally);
  DriftCosts costs() const;

  Finder& finder() { return *finder_; }
  Neighbours& neighbours() { return neighbours_; }
  void use(std::unique_ptr<Finder> finder) { finder_ = std::move(finder); }

  // of the DriftPhase
  DriftWatch* watch = nullptr;
  bool always_in_strips = false;
  bool every_candidate = false;

private:
  struct InPlace;
  /// A pair that may touch in the step: the lower id first, the image that of the higher.
  struct Candidate {
    std::uint32_t low, high;
    Image image;
  };

  void prepare();
  bool in_strips(const std::vector<Event>& first);
  void count(const Contact& contact, CollisionTally& tally);
  template<class Body> void for_each_block(const Body& body) const;
  void reject();
  void put_in_order(std::vector<Candidate>& candidates) const;
  std::vector<Event> solve();
  std::size_t bytes() const;

  CollisionSettings settings_;
  Frequencies frequencies_;
  double orbital_frequency_, step_;
  std::unique_ptr<Finder> finder_;

  // the step at hand
  Particles* particles_ = nullptr; // only while it goes on
  StepAtHand step_at_hand_;
  DriftStep finder_step_;
  bool through_grid_ = false;
  Neighbours neighbours_;
  GridPartners grid_;
  std::vector<std::vector<Candidate>> candidates_;
  EventQueue events_;
  Strips strips_;
  StepSoFar so_far_;
  Crowds crowds_;
  std::vector<std::uint32_t> touched_; // who has changed in this step
  std::uint64_t gave_up_ = 0;
  DriftCosts costs_;
};

} // namespace keeler
