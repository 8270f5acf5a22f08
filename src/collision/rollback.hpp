// Rolls back contacts that a new path contradicts. For optimistic_orbits.hpp and optimistic_loop.cpp alone.
//
// A contact that was deferred to a later round may precede contacts that an earlier round has carried out. So each new
// path is searched against the paths on its list that ended after it began. Where it meets one, or one that ended at
// the same instant, the contact that ended that path is rolled back, after all later ones of its two particles.
#pragma once

#include "optimistic_domain.hpp"
#include "step_context.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::collision {

/// Gives a particle the path back that this change ended. If it is then outside its skin, its list must be rebuilt:
/// only the last round may do so, and only where it has rebuilt the list before.
inline void restore_path(ChangeNumber number, Particles& particles, ChangeLog& log, NeighbourLists& lists,
                         bool may_rebuild) {
  log.restore(number, particles);
  const Change& change = log[number];
  const bool stays = lists.changed(change.particle, change.begin);
  if (!stays && may_rebuild)
    lists.rebuild_list(change.particle);
}

class Rollback {
public:
  Rollback(const StepContext& step, StepHistory& history, NeighbourLists& lists, OptimisticState& state,
           const DomainScope& scope, DomainLocks& locks)
      : step_(step), history_(history), lists_(lists), state_(state), scope_(scope), locks_(locks) {}

  /// Rolls back all contacts that ended a path which one of the new paths meets, and what contradicts the paths that
  /// hold again because of that. A path is left to a later round if its list, or what must be rolled back, is beyond
  /// the domain's scope.
  void resolve(std::span<const NewPath> paths) {
    paths_.assign(paths.begin(), paths.end());
    reinstated_.clear();
    for (std::size_t k = 0; k < paths_.size(); ++k) {
      const NewPath path = paths_[k];
      assert(scope_.owns(path.particle));
      bool resolved = scope_.encloses(path.particle); // else other domains may change what first_met() reads
      if (resolved)
        for (const std::uint32_t j : lists_.list(path.particle))
          if (const ChangeNumber number = first_met(path, j))
            resolved &= roll_back(number);
      if (!resolved)
        leave(path);
    }
    paths_.clear();
  }

  /// Returns the particles that the last resolve() gave an earlier path back.
  std::span<const std::uint32_t> reinstated() const { return reinstated_; }

private:
  OptimisticDomain& domain() { return state_.domains[scope_.domain()]; }
  bool owns_around(std::uint32_t i) const { return scope_.owns(i) && scope_.encloses(i); }

  // Leaves a path, and all events of its particle, to a later round.
  void leave(const NewPath& path) {
    domain().unresolved.push_back(path);
    locks_.lock(path.particle);
  }

  // Returns the first change of j that ended a path which the new one meets, or 0. Changes of this domain are in order.
  // All paths stay within their skins, so the list has all that may meet.
  ChangeNumber first_met(const NewPath& path, std::uint32_t j) const {
    ChangeNumber first = 0;
    for (ChangeNumber number = state_.log.newest(history_, j); number; number = state_.log[number].earlier) {
      const Change& past = state_.log[number];
      if (past.time < path.from)
        break;
      if (ChangeLog::domain_of(number) != scope_.domain() && meets(path, j, past))
        first = number;
    }
    return first;
  }

  // Rolls back the contact of that change, after all later contacts of its particles. Returns false if one of them is
  // beyond the domain's scope; later ones are rolled back nevertheless, which is never wrong.
  bool roll_back(ChangeNumber number) {
    to_undo_.assign(1, number);
    while (!to_undo_.empty()) {
      const ChangeNumber last = to_undo_.back(), partner = ChangeLog::partner_of(last);
      DomainContacts& contacts = state_.domains[ChangeLog::domain_of(last)].contacts;
      const std::size_t contact = ChangeLog::contact_of(last);
      if (contacts.is_rolled_back(contact)) {
        to_undo_.pop_back();
        continue;
      }
      const Change &one = state_.log[last], &other = state_.log[partner];
      if (!owns_around(one.particle) || !owns_around(other.particle))
        return false;
      const ChangeNumber newest_one = state_.log.newest(history_, one.particle),
                         newest_other = state_.log.newest(history_, other.particle);
      if (newest_one != last || newest_other != partner) {
        to_undo_.push_back(newest_one != last ? newest_one : newest_other);
        continue;
      }
      contacts.roll_back(contact);
      ++domain().rolled_back;
      for (const ChangeNumber undone : {last, partner})
        reinstate(undone);
      to_undo_.pop_back();
    }
    return true;
  }

  void reinstate(ChangeNumber undone) {
    const Change& change = state_.log[undone];
    history_.reinstate(change.particle, change.begin);
    restore_path(undone, step_.particles, state_.log, lists_, scope_.is_last());
    paths_.push_back({change.particle, change.time});
    reinstated_.push_back(change.particle);
  }

  // True if the finder has a contact of the new path with the path of j that ended with `past`.
  bool meets(const NewPath& path, std::uint32_t j, const Change& past) const {
    if (path.from == past.time)
      return true;
    const std::uint32_t i = path.particle;
    const Particles& particles = step_.particles;
    const bool ordered = particles.ids[i] < particles.ids[j];
    const Body& one = particles.bodies[i];
    Body other = particles.bodies[j];
    other.elements = past.ended;
    const Image image = lists_.nearest_image(one, other);
    const Vec3 shift = step_.box.displacement(ordered ? image : -image, step_.offset);
    const finders::Query query{ordered ? i : j, ordered ? j : i, shift.x(), shift.y(), std::max(path.from, past.begin)};
    const finders::FinderResult result = step_.finder.find_between(query, ordered ? one : other, ordered ? other : one);
    return (result.contact() && result.time <= past.time) || result.exit == finders::FinderExit::not_a_number;
  }

  const StepContext& step_;
  StepHistory& history_;
  NeighbourLists& lists_;
  OptimisticState& state_;
  const DomainScope& scope_;
  DomainLocks& locks_;
  std::vector<NewPath> paths_; // yet to be searched
  std::vector<std::uint32_t> reinstated_;
  std::vector<ChangeNumber> to_undo_;
};

} // namespace keeler::collision
