// What one domain of a round sees of the particles and how it changes them: the orbits of its ContactLoop. For
// optimistic_loop.cpp alone; what it keeps to is told in optimistic_loop.hpp.
#pragma once

#include "optimistic_loop.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

struct OptimisticLoop::Orbits {
  OptimisticLoop& all;
  Domain& domain;
  std::size_t round;
  std::size_t own;      // number in the round
  std::uint64_t margin; // how far lists reach across
  std::size_t next_barred = 0;
  std::vector<std::uint32_t> barred{}, buffer{};
  bool leaves_slack = false;          // one of the two that were changed last
  std::vector<NewPath> paths{};       // of the contact at hand
  std::vector<std::uint32_t> again{}; // who has an earlier path again
  std::vector<std::uint32_t> to_undo{};

  std::size_t number() const { return static_cast<std::size_t>(&domain - all.domains_.data()); }
  bool is_last() const { return round + 1 == rounds; }
  const Body& body(std::size_t i) const { return all.particles_->bodies[i]; }
  std::uint32_t stamp(std::size_t i) const { return all.so_far_->stamp(i); }
  double last_change(std::size_t i) const { return all.so_far_->last_change(i); }

  bool is_due(const Event& event) {
    if (domain.failed)
      return false;
    for (; next_barred < domain.barred.size() && domain.barred[next_barred].time <= event.time; ++next_barred)
      if (const Barred& b = domain.barred[next_barred]; b.stamp == stamp(b.place))
        bar(b.place);
    if (!all.so_far_->holds(event))
      return false;
    const bool due =
        !(all.barred_[event.low] || all.barred_[event.high]) && encloses(event.low) && encloses(event.high);
    if (!due)
      defer(event);
    return due;
  }

  // Whether everybody on the list is the domain's own.
  bool encloses(std::uint32_t i) const {
    if (is_last())
      return true;
    const std::uint64_t inside = all.lists_->across(i) - domain.begin; // most are far from both edges
    if (inside > margin && inside + margin < domain.width)
      return true;
    for (const std::uint32_t j : all.lists_->list(i))
      if (all.owner(round, j) != own)
        return false;
    return true;
  }

  // Of two particles that were just changed.
  bool keeps(const Event& event) {
    if (leaves_slack) { // lists are for all domains: they change when there is one
      leaves_slack = false;
      all.take_back(domain);
      defer(event);
      return false;
    }
    if (all.lists_->reaches_far()) {
      domain.failed = true;
      return false;
    }
    again.clear();
    if (round > 0) {
      paths.assign({{event.low, event.time}, {event.high, event.time}});
      resolve();
    }
    return true;
  }
  std::span<const std::uint32_t> to_search_again() const { return again; }

  // Rolls back whatever ended a path that one of the new ones meets.
  void resolve() {
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const NewPath path = paths[k];
      for (const std::uint32_t j : all.lists_->list(path.place))
        if (const std::uint32_t number = first_met(path, j); number && !roll_back(number)) {
          domain.unresolved.push_back(path);
          bar(path.place);
        }
    }
    paths.clear();
  }

  // The first change of j that ended a path which the new one meets; 0: none. What this domain has changed in this
  // round is in order. All stay within their slack, so who may meet is listed.
  std::uint32_t first_met(const NewPath& path, std::uint32_t j) const {
    std::uint32_t first = 0;
    for (std::uint32_t number = all.newest(j); number; number = all.change(number).earlier) {
      const Change& past = all.change(number);
      if (past.time < path.from)
        break;
      if ((number - 1) / max_changes != this->number() && meets(path.place, path.from, j, past))
        first = number;
    }
    return first;
  }

  // The contact of that change, after all later ones of its particles. False: one of them is not the domain's; those
  // after it are rolled back nevertheless, which is never wrong.
  bool roll_back(std::uint32_t number) {
    to_undo.assign(1, number);
    while (!to_undo.empty()) {
      const std::uint32_t last = to_undo.back(), partner = ((last - 1) ^ 1u) + 1;
      Domain& its = all.domain_of(last);
      const std::size_t contact = (last - 1) % max_changes / 2;
      if (its.is_rolled_back[contact]) {
        to_undo.pop_back();
        continue;
      }
      const Change &one = all.change(last), &other = all.change(partner);
      if (!owns_around(one.place) || !owns_around(other.place))
        return false;
      const std::uint32_t newest_one = all.newest(one.place), newest_other = all.newest(other.place);
      if (newest_one != last || newest_other != partner) {
        to_undo.push_back(newest_one != last ? newest_one : newest_other);
        continue;
      }
      its.is_rolled_back[contact] = 1;
      ++domain.rolled_back;
      for (const std::uint32_t undone : {last, partner}) {
        const Change& change = all.change(undone);
        all.so_far_->renew(change.place, change.begin);
        all.restore(its, (undone - 1) % max_changes, is_last());
        paths.push_back({change.place, change.time});
        again.push_back(change.place);
      }
      to_undo.pop_back();
    }
    return true;
  }

  bool owns_around(std::uint32_t i) const { return all.owner(round, i) == own && encloses(i); }

  void defer(const Event& event) {
    domain.deferred.push_back(event);
    bar(event.low);
    bar(event.high);
  }

  void bar(std::uint32_t i) {
    all.barred_[i] = 1;
    barred.push_back(i);
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    assert(all.owner(round, i) == own);
    Body& body = all.particles_->bodies[i];
    const std::uint32_t earlier = all.newest(i);
    assert(!earlier || all.change(earlier).time <= time);
    if (earlier && (earlier - 1) / max_changes != number()) // made at this instant: ids can't tell their order
      domain.failed |= all.change(earlier).time >= time;
    domain.failed |= domain.changes.size() + 3 > max_changes;
    if (!earlier)
      domain.touched.push_back(i);
    all.newest_[i] = number_of(number(), domain.changes.size());
    domain.changes.push_back({i, earlier, last_change(i), time, body.elements});
    if (all.particles_->rough)
      domain.spins.push_back(all.particles_->spins[i]);
    all.so_far_->change(i, time);
    body.elements = elements;
    if (!all.lists_->changed(i, time)) {
      if (is_last())
        all.lists_->rebuild_list(i);
      else
        leaves_slack = true;
    }
  }

  void set_spin(std::uint32_t i, const Vec3& spin) { all.particles_->spins[i] = spin; }

  bool meets(std::uint32_t i, double time, std::uint32_t j, const Change& past) const {
    if (time == past.time)
      return true;
    const bool ordered = all.particles_->ids[i] < all.particles_->ids[j];
    const Body& one = body(i);
    Body other = body(j);
    other.elements = past.ended;
    const Image image = all.lists_->nearest_image(one, other);
    const Vec3 shift = all.step_->box.displacement(ordered ? image : -image, all.step_->offset);
    const Query query{ordered ? i : j, ordered ? j : i, shift.x(), shift.y(), std::max(time, past.begin)};
    const FinderResult result = all.finder_->find_between(query, ordered ? one : other, ordered ? other : one);
    return (result.contact() && result.time <= past.time) || result.exit == FinderExit::not_a_number;
  }

  bool may_look_again(std::uint32_t i) const { return all.lists_->has_many(i); }
  template<class Visit> void visit_partners(std::size_t i, double from, double until, const Visit& visit) {
    all.lists_->visit_partners(i, from, until, buffer, visit);
  }
  void find_all(std::span<const Query> queries, std::span<FinderResult> results) const {
    all.finder_->find_all(queries, results);
  }
  void prefetch_partner(std::size_t i) const { all.so_far_->prefetch(i); }
  void prefetch(std::size_t i, int stage) const {
    all.lists_->prefetch(i, stage);
    if (stage == 0) {
      all.so_far_->prefetch(i);
      __builtin_prefetch(&all.newest_[i], 1);
      __builtin_prefetch(&all.barred_[i], 1);
    }
  }
  void happened(const Contact& contact) {
    domain.contacts.push_back(contact);
    domain.is_rolled_back.push_back(0);
  }
  void record(const CollisionRecord& record) { domain.records.push_back(record); }
};

} // namespace keeler
