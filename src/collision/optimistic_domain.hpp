// One domain of a parallel step: its events and contacts, and which particles it may change.
#pragma once

#include "change_log.hpp"
#include "domain_contacts.hpp"
#include "domain_cut.hpp"
#include "neighbours/neighbour_lists.hpp"
#include "particle_locks.hpp"

#include <keeler/collision/events.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

/// The path of a particle from a time on, to be searched against the paths that ended later.
struct NewPath {
  std::uint32_t particle;
  double from;
};

struct alignas(64) OptimisticDomain { // no two threads write to one cache line
  LockSchedule lock_schedule;         // for events of a particle of the domain with one of another domain
  std::vector<Event> deferred;        // left to the next round; of those events, the ones of the lower id's domain
  DomainContacts contacts;
  std::vector<NewPath> unresolved;  // paths that are left to a later round (rollback.hpp)
  std::vector<std::uint32_t> dirty; // particles that changed for the first time here
  std::uint64_t max_partners = 0;
  std::uint64_t rolled_back = 0; // contacts
  bool failed = false;

  void clear();
  std::size_t bytes() const;
};

/// What all domains of a step work on. A domain writes only to its own entries and to entries of particles that it
/// owns.
struct OptimisticState {
  DomainCut cut;
  ChangeLog log;
  ParticleLocks locks;
  std::vector<OptimisticDomain> domains; // round by round
};

/// The particles that a domain may change. By position of the reference paths, so this is constant in a round.
class DomainScope {
public:
  /// `domain` is the number among all rounds.
  DomainScope(const DomainCut& cut, const NeighbourLists& lists, std::size_t round, std::size_t domain)
      : cut_(cut), lists_(lists), round_(round), domain_(domain), own_(domain - cut.begin_of(round)),
        farthest_(lists.farthest_neighbour()) {
    assert(domain >= cut.begin_of(round) && domain < cut.end_of(round));
  }

  std::size_t domain() const { return domain_; }
  std::size_t round() const { return round_; }
  bool is_last() const { return round_ + 1 == DomainCut::rounds; }

  bool owns(std::uint32_t i) const { return cut_.owner(round_, lists_.position(i)) == own_; }

  /// True if the domain owns all particles on the list of i. Precondition: it owns i.
  bool encloses(std::uint32_t i) const {
    if (cut_.is_inside(round_, lists_.position(i), farthest_)) // most are far from all edges
      return true;
    for (const std::uint32_t j : lists_.list(i))
      if (!owns(j))
        return false;
    return true;
  }

private:
  const DomainCut& cut_;
  const NeighbourLists& lists_;
  std::size_t round_, domain_, own_; // own_: number in the round
  BoxDistance farthest_;             // that lists reach
};

} // namespace keeler::collision
