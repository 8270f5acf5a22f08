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
  std::vector<Event> assigned;        // the domain owns both particles
  std::vector<Event> cross_domain;    // it owns the particle with the lower id; another domain owns the other
  std::vector<Event> deferred;        // left to the next round
  LockSchedule lock_schedule;
  DomainContacts contacts;
  std::vector<NewPath> unresolved;  // paths that meet a path which the domain may not roll back
  std::vector<std::uint32_t> dirty; // particles that changed for the first time here
  EventQueue events;
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
        strip_(is_last() ? DomainCut::Strip{} : cut.strip(domain)), margin_(lists.farthest_across()) {
    assert(domain >= cut.begin_of(round) && domain < cut.end_of(round));
  }

  std::size_t domain() const { return domain_; }
  std::size_t round() const { return round_; }
  bool is_last() const { return round_ + 1 == DomainCut::rounds; }

  bool owns(std::uint32_t i) const { return cut_.owner(round_, lists_.across(i)) == own_; }

  /// True if the domain owns all particles on the list of i. Precondition: it owns i.
  bool encloses(std::uint32_t i) const {
    if (is_last())
      return true;
    const std::uint64_t inside = lists_.across(i) - strip_.begin; // most are far from both edges
    if (inside > margin_ && inside + margin_ < strip_.width)
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
  DomainCut::Strip strip_;
  std::uint64_t margin_; // farthest that lists reach across
};

} // namespace keeler::collision
