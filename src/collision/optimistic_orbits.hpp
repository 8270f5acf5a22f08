// The OrbitStore of one domain in a round of a parallel step. For optimistic_loop.cpp alone, which says what a domain
// may read and change.
#pragma once

#include "contact_loop.hpp"
#include "rollback.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

namespace keeler::collision {

class DomainOrbits {
public:
  DomainOrbits(const StepContext& step, StepHistory& history, NeighbourLists& lists, OptimisticState& state,
               const DomainScope& scope)
      : step_(step), history_(history), lists_(lists), state_(state), domain_(state.domains[scope.domain()]),
        scope_(scope), locks_(state.locks), rollback_(step, history, lists, state, scope, locks_) {}

  const Body& body(std::size_t i) const { return step_.particles.bodies[i]; }
  std::uint32_t event_count(std::size_t i) const { return history_.event_count(i); }
  double last_change(std::size_t i) const { return history_.last_change(i); }

  /// Defers a valid event if a particle is locked or has neighbours beyond the domain.
  bool is_due(const Event& event) {
    if (domain_.failed)
      return false;
    domain_.lock_schedule.visit_due(event.time, [&](std::uint32_t i, std::uint32_t count_then) {
      if (count_then == event_count(i))
        locks_.lock(i);
    });
    if (!history_.is_valid(event))
      return false;
    const bool due = !(locks_.is_locked(event.low) || locks_.is_locked(event.high)) && scope_.encloses(event.low) &&
                     scope_.encloses(event.high);
    if (!due)
      defer(event);
    return due;
  }

  void add(const Contact& contact) { domain_.contacts.add(contact); }
  void add(const CollisionRecord& record) { domain_.contacts.add(record); }

  void change(std::uint32_t i, const Elements& elements, double time) {
    assert(scope_.owns(i));
    const ChangeNumber earlier = state_.log.newest(history_, i);
    assert(!earlier || state_.log[earlier].time <= time);
    if (earlier && ChangeLog::domain_of(earlier) != scope_.domain()) // if at this instant, ids cannot give their order
      domain_.failed |= state_.log[earlier].time >= time;
    domain_.failed |= !state_.log.has_room(scope_.domain());
    if (!earlier)
      domain_.dirty.push_back(i);
    Body& body = step_.particles.bodies[i];
    state_.log.add(scope_.domain(), {i, earlier, last_change(i), time, body.elements}, step_.particles);
    history_.change(i, time);
    body.elements = elements;
    if (!lists_.changed(i, time)) {
      if (scope_.is_last())
        lists_.rebuild_list(i);
      else
        has_left_skin_ = true;
    }
  }

  void set_spin(std::uint32_t i, const Vec3& spin) { step_.particles.spins[i] = spin; }

  /// Keeps the contact of the last two changes, or undoes and defers it: all domains read the lists, so only the last
  /// round, which is one domain, may change them.
  bool commit(const Event& event) {
    assert(state_.log.size(scope_.domain()) == 2 * domain_.contacts.size());
    if (has_left_skin_) {
      has_left_skin_ = false;
      undo_last_contact();
      defer(event);
      return false;
    }
    if (lists_.reaches_far()) {
      domain_.failed = true;
      return false;
    }
    if (scope_.round() > 0) {
      const NewPath paths[] = {{event.low, event.time}, {event.high, event.time}};
      rollback_.resolve(paths);
    }
    return true;
  }

  /// Of the paths that earlier rounds have left, takes up the ones of this domain's particles.
  void resolve(std::span<const NewPath> paths) {
    std::vector<NewPath> own;
    std::copy_if(paths.begin(), paths.end(), std::back_inserter(own),
                 [&](const NewPath& path) { return scope_.owns(path.particle); });
    rollback_.resolve(own);
  }
  std::span<const std::uint32_t> reinstated() const { return rollback_.reinstated(); }

  bool may_repredict(std::uint32_t i) const { return lists_.has_many(i); }
  template<class Visit> void visit_partners(std::size_t i, double from, double until, const Visit& visit) {
    lists_.visit_partners(i, from, until, buffer_, visit);
  }
  void find_all(std::span<const finders::Query> queries, std::span<finders::FinderResult> results) const {
    step_.finder.find_all(queries, results);
  }

private:
  void defer(const Event& event) {
    domain_.deferred.push_back(event);
    locks_.lock(event.low);
    locks_.lock(event.high);
  }

  // Undoes this domain's most recent contact. Safe: no other domain has read it.
  void undo_last_contact() {
    domain_.contacts.remove_last();
    for (int both = 0; both < 2; ++both) {
      const std::size_t domain = scope_.domain();
      const ChangeNumber number = ChangeLog::number_of(domain, state_.log.size(domain) - 1);
      const Change& last = state_.log[number];
      history_.undo_last_change(last.particle, last.begin);
      if (!last.earlier)
        domain_.dirty.pop_back();
      restore_path(number, step_.particles, state_.log, lists_, false);
      state_.log.remove_last(domain);
    }
  }

  const StepContext& step_;
  StepHistory& history_;
  NeighbourLists& lists_;
  OptimisticState& state_;
  OptimisticDomain& domain_;
  const DomainScope& scope_;
  DomainLocks locks_;
  Rollback rollback_;
  std::vector<std::uint32_t> buffer_; // of visit_partners()
  bool has_left_skin_ = false;        // one of the two particles changed last
};

} // namespace keeler::collision
