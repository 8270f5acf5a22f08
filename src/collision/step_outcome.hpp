// What the contacts of one step did: sums, records and lists, cleared when the next step begins.
#pragma once

#include "contact.hpp"

#include <keeler/collision/costs.hpp>
#include <keeler/collision/drift.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/core/exact_sum.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

struct StepOutcome {
  std::vector<std::uint32_t> dirty;     ///< particles that were hit; more than once after rollbacks
  std::vector<SlowPair> slow_pairs;     ///< in the order of events
  std::vector<CollisionRecord> records; ///< for an observer that wants them
  ExactSum energy_lost, momentum_flux, azimuthal_gain, kick_work;
  std::uint64_t gave_up = 0; ///< searches

  /// Forgets the contacts; particles that were hit stay dirty.
  void clear_contacts() {
    slow_pairs.clear();
    records.clear();
    energy_lost = momentum_flux = azimuthal_gain = kick_work = {};
    gave_up = 0;
  }
  /// Appends later contacts of the step.
  void append(const StepOutcome& later) {
    dirty.insert(dirty.end(), later.dirty.begin(), later.dirty.end());
    slow_pairs.insert(slow_pairs.end(), later.slow_pairs.begin(), later.slow_pairs.end());
    records.insert(records.end(), later.records.begin(), later.records.end());
    energy_lost += later.energy_lost;
    momentum_flux += later.momentum_flux;
    azimuthal_gain += later.azimuthal_gain;
    kick_work += later.kick_work;
    gave_up += later.gave_up;
  }
  void clear() {
    dirty.clear();
    clear_contacts();
  }
  /// Adds the sums of the step; counts of contacts are in the tally already.
  void add_sums_to(CollisionTally& tally) const {
    tally.gave_up += gave_up;
    tally.energy_lost += energy_lost.value();
    tally.momentum_flux += momentum_flux.value();
    tally.azimuthal_gain += azimuthal_gain.value();
  }
};

/// Counts the contacts of one step.
struct ContactCounter {
  static constexpr std::size_t all_particles = ~std::size_t{0};

  StepOutcome& outcome;
  CollisionTally& tally;
  DriftCosts& costs;
  std::size_t own = all_particles; ///< the first so many particles are this rank's; others are ghosts

  /// Adds a contact, in the order of events. Returns false if its owner is another rank, which counts it.
  bool add(const Contact& contact) const {
    if (Communicator::possible && contact.low >= own)
      return false;
    ++(contact.fast ? tally.fast : tally.slow);
    tally.unresolved += contact.unresolved;
    outcome.energy_lost += contact.energy_lost;
    outcome.momentum_flux += contact.momentum_flux;
    outcome.azimuthal_gain += contact.azimuthal_gain;
    outcome.kick_work += contact.kick_work;
    ++costs.contacts;
    costs.recontacts += contact.recontact;
    if (contact.slow > 0.0F)
      outcome.slow_pairs.push_back({contact.low, contact.high, contact.slow});
    return true;
  }
};

} // namespace keeler::collision
