// One drift step as all parts of the drift phase see it. DriftEngine makes the context when the step begins and passes
// it down; nothing keeps it beyond the step.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/finders/finder.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

namespace keeler::collision {

struct StepContext {
  Particles& particles;
  const CollisionSettings& settings;
  finders::Finder& finder; ///< begins the step before the first search
  Frequencies frequencies;
  double orbital_frequency; ///< rad/s
  ShearingBox box;
  double offset;    ///< shear offset at the epoch, m
  double begin;     ///< −h/2: rad from the epoch
  double kick_pull; ///< G times the kick interval, m³ kg⁻¹ rad⁻¹: slower contacts are unresolved
  double rest_pull; ///< likewise, for DriftPhase::slow_pairs()
  KickInterval gravity;

  DriftObserver* watcher;      ///< sees each search, contact and change; nullptr: none
  DriftObserver* record_taker; ///< receives all records at the end of the step; nullptr: none

  double end() const { return -begin; }
  /// True if contacts must be recorded.
  bool recorded() const { return watcher || record_taker; }
};

} // namespace keeler::collision
