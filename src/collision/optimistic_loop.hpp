// The contacts of one step on several threads, in place, with the bits of the sequential order: optimistic parallel
// simulation with rollback (Jefferson 1985; for hard spheres Lubachevsky 1992, Miller & Luding 2004).
//
// Owner: the box is cut across into domains, one for a thread; each particle belongs to one. Deferred: a domain carries
// out, in order, the contacts of which it owns both particles and everybody on their lists, who are all that the search
// after the contact reads. It defers the rest, and from then on everything of those two particles. What was deferred is
// carried out by a second round of domains, cut through the middles of the first ones, and what these defer by a last
// one that is the whole box.
//
// Rollback: two domains of a round never touch. But a contact that was deferred may come before one that was carried
// out, and have a say in it. So every new orbit of a later round is searched against the paths that ended after it
// began. Where it meets one, or one ended at the very same instant, the contact that ended that path is rolled back,
// and with it all later ones of its two particles, and so on. Who has an earlier path again is searched again, in the
// same way. A domain of the second round rolls back what it owns, and leaves the rest to the last one. When nothing is
// left, then by induction over the events every pending contact has been found and none is made up: what has happened
// is the sequential history.
//
// Invariants: in a round a domain changes only what it owns, and reads only what it owns and lists, which nobody
// changes but the last round; `newest_` is each particle's last change; changes of a particle follow each other in
// time; a particle's stamp never comes back, so that what was found for a path that was rolled back never holds.
//
// What does not fit, be it an orbit too fast for nearest images, several contacts at one instant of which a later round
// has one (which of them the sequence has first depends on what was found when), or an error, is left to the sequential
// loop, with everything as at the start of the step.
#pragma once

#include "contact_loop.hpp"
#include "neighbours/neighbour_lists.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace keeler {

class OptimisticLoop {
public:
  /// How many domains a round may have: those of three rounds are numbered in a byte, beside their changes.
  static constexpr std::size_t max_domains = 127;

  /// Carries out everything that follows from the first contacts of a step, for an exact finder, in so many domains.
  /// Returns false when that should be done in sequence, with everything as it was.
  bool carry_out(const StepAtHand& step, Particles& particles, StepSoFar& so_far, const Finder& finder,
                 NeighbourLists& lists, const std::vector<Event>& first, std::size_t domains);

  /// How many of the step there were.
  std::size_t contacts() const;
  /// Calls visit(contact, its record or null) for each of them, in the order of events.
  template<class Visit> void visit_contacts(const Visit& visit) const;
  /// Calls visit(end of the path, its elements, spin) for each change of a particle that held, the
  /// last one first.
  template<class Visit> void visit_changes(std::uint32_t place, const Visit& visit) const;
  /// Each particle that was hit; who was rolled back and hit again, again.
  void list_touched(std::vector<std::uint32_t>& touched) const;
  /// Of one particle in one search of the step.
  std::uint64_t max_partners() const;

  std::uint64_t deferred = 0, last_deferred = 0, rolled_back = 0; ///< so far: events to round 2, to the last; contacts
  std::size_t bytes() const;

private:
  static constexpr std::size_t rounds = 3;
  static constexpr std::uint32_t max_changes = 1u << 24; // of a domain
  static_assert((2 * max_domains + 1) * std::uint64_t{max_changes} < std::uint64_t{1} << 32);

  /// The end of a particle's path, and what it takes to roll it back. Each contact makes two that follow each other.
  struct Change {
    std::uint32_t place;
    std::uint32_t earlier; // the number of that particle's last one before; 0: none in this step
    double begin, time;    // of the path that ended
    Elements ended;
  };
  /// The present path of a particle from a time on, to be searched against paths that ended since.
  struct NewPath {
    std::uint32_t place;
    double from;
  };
  /// A contact with a partner of another domain: from then on a particle that has not changed is not for its own.
  struct Barred {
    double time;
    std::uint32_t place, stamp;
  };
  struct alignas(64) Domain { // two threads share no line of cache
    std::uint32_t begin = 0;  // of its place across the box, a fraction of it (2⁻³²),
    std::uint64_t width = 0;  // and so wide
    std::vector<Event> given, deferred;
    std::vector<Event> aside; // of which no domain of the round has both particles
    std::vector<Barred> barred;
    std::vector<Change> changes;
    std::vector<Vec3> spins; // before each change; none of smooth particles
    std::vector<Contact> contacts;
    std::vector<CollisionRecord> records;     // of each contact; none unless the step is recorded
    std::vector<std::uint8_t> is_rolled_back; // each contact
    std::vector<NewPath> unresolved;          // that meet what is not the domain's
    std::vector<std::uint32_t> touched;       // by it first of all domains
    EventQueue events;
    std::uint64_t max_partners = 0;
    std::uint64_t rolled_back = 0;
    bool failed = false;

    void clear();
  };
  struct Orbits;

  std::size_t begin_of(std::size_t round) const { return round * across_; }
  std::size_t end_of(std::size_t round) const { return std::min((round + 1) * across_, domains_.size()); }
  // Number in the round of the domain that owns a particle, by where its reference stands.
  std::size_t owner(std::size_t round, std::size_t place) const {
    if (round + 1 == rounds)
      return 0;
    const auto after = std::upper_bound(edges_.begin(), edges_.end(), lists_->across(place)) - edges_.begin();
    const std::size_t halves = edges_.size(), half = static_cast<std::size_t>(after) + halves - 1 - round;
    return half % halves / 2;
  }
  // Numbers of changes, from 1 on, tell their domain.
  static std::uint32_t number_of(std::size_t domain, std::size_t change) {
    return static_cast<std::uint32_t>(domain * max_changes + change + 1);
  }
  Domain& domain_of(std::uint32_t number) { return domains_[(number - 1) / max_changes]; }
  const Change& change(std::uint32_t number) const {
    return domains_[(number - 1) / max_changes].changes[(number - 1) % max_changes];
  }
  std::uint32_t newest(std::size_t place) const { return so_far_->stamp(place) > 0 ? newest_[place] : 0; }

  void cut(const std::vector<Event>& first);
  void deal(std::size_t round, std::span<const Event> events);
  void run(std::size_t round, const std::vector<Event>& events);
  void run(std::size_t round, Domain& domain);
  std::vector<Event> left_by(std::size_t round) const;
  void restore(const Domain& domain, std::size_t change, bool alone);
  void take_back(Domain& domain);
  bool put_in_order();
  bool roll_back_all();

  // the step at hand
  const StepAtHand* step_ = nullptr;
  Particles* particles_ = nullptr;
  StepSoFar* so_far_ = nullptr;
  const Finder* finder_ = nullptr;
  NeighbourLists* lists_ = nullptr;

  std::size_t across_ = 0;            // domains of the first and of the second round
  std::vector<std::uint32_t> edges_;  // of half domains, across the box
  std::vector<Domain> domains_;       // round by round
  std::vector<std::uint32_t> newest_; // the number of each particle's last change, if it has a stamp
  std::vector<std::uint8_t> barred_;  // each particle from its domain of the round at hand
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order_; // of events: domain and number of each contact that held
};

template<class Visit> void OptimisticLoop::visit_contacts(const Visit& visit) const {
  for (const auto& [domain, contact] : order_) {
    const Domain& its = domains_[domain];
    visit(its.contacts[contact], its.records.empty() ? nullptr : &its.records[contact]);
  }
}

template<class Visit> void OptimisticLoop::visit_changes(std::uint32_t place, const Visit& visit) const {
  for (std::uint32_t number = newest(place); number; number = change(number).earlier) {
    const std::vector<Vec3>& spins = domains_[(number - 1) / max_changes].spins;
    visit(change(number).time, change(number).ended, spins.empty() ? Vec3::Zero() : spins[(number - 1) % max_changes]);
  }
}

} // namespace keeler
