// The contacts of one step in domains, on several threads or one, in place, with the bits of the sequential order:
// optimistic parallel simulation with rollback (Jefferson 1985; for hard spheres Lubachevsky 1992, Miller & Luding
// 2004).
//
// Ownership: the box is cut into blocks, the domains; each particle belongs to one. Deferral: a domain carries out, in
// order, the contacts of which it owns both particles and all particles on their lists, which is all that the search
// after the contact reads. It defers the others, and from then on all events of their two particles (locks). A second
// round of domains, shifted by half a block, carries out what was deferred, and a third, shifted by a quarter, what the
// second deferred; a last round, one domain for the whole box, carries out the rest.
//
// Rollback (rollback.hpp): contacts of two domains of one round are independent, but a contact that was deferred may
// precede and change one that was carried out. So each new path of a later round is searched against the paths that
// ended after it began. Contacts that it contradicts are rolled back, and particles that have an earlier path again are
// searched again in the same way. A domain rolls back only what it owns and leaves the rest to a later round, which
// begins with that. When nothing is left, then by induction over the events every pending contact has been found and
// none is made up: the result is the sequential history.
//
// Invariants: in a round a domain changes only what it owns, and reads only what it owns and lists, which nothing
// changes but the last round; changes of a particle follow each other in time; an event count never returns to an old
// value, so predictions for a path that was rolled back stay invalid.
//
// Left to the sequential loop, with everything as at the start of the step: orbits too fast for nearest images, several
// contacts at one instant of which a later round has one (the sequential order of these depends on when they were
// found), and errors.
#pragma once

#include "contact.hpp"
#include "contact_order.hpp"
#include "optimistic_domain.hpp"
#include "step_context.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::collision {

class OptimisticLoop {
public:
  static constexpr std::size_t max_domains = DomainCut::max_domains;

  struct Counts {
    std::uint64_t deferred = 0;      ///< events left to the second round
    std::uint64_t last_deferred = 0; ///< events left to the last round
    std::uint64_t rolled_back = 0;   ///< contacts
    std::uint64_t abandoned = 0;     ///< calls that returned false
  };

  /// Carries out all contacts that follow from the first ones of a step, in so many domains per round. Returns false if
  /// that must be done in sequence, with everything as it was. Preconditions: step.finder is exact; lists and history
  /// have begun the step; 0 < domains <= max_domains.
  bool carry_out(const StepContext& step, StepHistory& history, NeighbourLists& lists, const std::vector<Event>& first,
                 std::size_t domains);

  // The results of the last carry_out() that returned true.

  /// Number of contacts of the step, which are in the order of events.
  std::size_t contacts() const { return order_.size(); }
  const Contact& contact(std::size_t k) const { return log_of(k)[order_[k].contact]; }
  /// Returns nullptr if the step is not recorded.
  const CollisionRecord* record(std::size_t k) const { return log_of(k).record(order_[k].contact); }
  /// Calls visit(end of the path, its elements, spin) for each change of a particle, the last one first.
  template<class Visit>
  void visit_changes(const StepHistory& history, std::uint32_t particle, const Visit& visit) const;
  /// Calls visit(change) for the changes of all contacts that were not rolled back, as they lie in memory.
  template<class Visit> void visit_all_changes(const Visit& visit) const;
  /// Appends each particle that was hit; more than once if it was rolled back and hit again.
  void append_dirty(std::vector<std::uint32_t>& dirty) const;
  /// Returns the largest number of partners that one particle had in one search.
  std::uint64_t max_partners() const;

  /// Undoes the last carry_out() that returned true, and with it its results: everything is as at the start of the
  /// step.
  void undo(const StepContext& step, StepHistory& history, NeighbourLists& lists) {
    roll_back_all({step, history, lists});
  }

  /// Releases the memory of the last carry_out() and with it its results.
  void release();

  /// Returns the sums over all steps so far.
  const Counts& counts() const { return counts_; }
  std::size_t bytes() const;

private:
  /// What all rounds of one step are called with.
  struct Step {
    const StepContext& context;
    StepHistory& history;
    NeighbourLists& lists;
  };

  std::size_t owner(const Step& step, std::size_t round, std::uint32_t particle) const {
    return state_.cut.owner(round, step.lists.position(particle));
  }
  void begin_step(const Step& step, std::size_t domains);
  void assign(const Step& step, std::size_t round, std::span<const Event> events);
  void run_round(const Step& step, std::size_t round, const std::vector<Event>& events);
  std::vector<Event> own_events(const Step& step, std::size_t round, std::size_t domain, std::span<const Event> events);
  void run_domain(const Step& step, std::size_t round, std::size_t domain, std::span<const Event> events,
                  std::span<const NewPath> unresolved);
  std::vector<NewPath> take_unresolved(std::size_t end);
  std::vector<Event> left_by(std::size_t round) const;
  void roll_back_all(const Step& step);
  bool abandon(const Step& step);

  const DomainContacts& log_of(std::size_t k) const { return state_.domains[order_[k].domain].contacts; }

  OptimisticState state_;
  // of a round: indices of events, and where those of each domain begin
  std::vector<std::uint32_t> assigned_, assigned_begins_;
  ContactOrder order_;
  Counts counts_;
};

template<class Visit>
void OptimisticLoop::visit_changes(const StepHistory& history, std::uint32_t particle, const Visit& visit) const {
  const ChangeLog& log = state_.log;
  for (ChangeNumber number = log.newest(history, particle); number; number = log[number].earlier)
    visit(log[number].time, log[number].ended, log.spin_before(number));
}

template<class Visit> void OptimisticLoop::visit_all_changes(const Visit& visit) const {
  for (std::size_t d = 0; d < state_.domains.size(); ++d) {
    const DomainContacts& contacts = state_.domains[d].contacts;
    assert(state_.log.size(d) == 2 * contacts.size());
    for (std::size_t k = 0; k < state_.log.size(d); ++k)
      if (!contacts.is_rolled_back(k / 2))
        visit(state_.log[ChangeLog::number_of(d, k)]);
  }
}

} // namespace keeler::collision
