#include "optimistic_loop.hpp"

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {

// The store as one domain sees and changes it.
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
      if ((number - 1) / most_changes != this->number() && meets(path.place, path.from, j, past))
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
      const std::size_t contact = (last - 1) % most_changes / 2;
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
      for (const Change* change : {&one, &other}) {
        all.so_far_->renew(change->place, change->begin);
        all.restore(*change, is_last());
        paths.push_back({change->place, change->time});
        again.push_back(change->place);
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
    if (earlier && (earlier - 1) / most_changes != number()) // made at this instant: ids can't tell their order
      domain.failed |= all.change(earlier).time >= time;
    domain.failed |= domain.changes.size() + 3 > most_changes;
    if (!earlier)
      domain.touched.push_back(i);
    all.newest_[i] = number_of(number(), domain.changes.size());
    domain.changes.push_back({i, earlier, last_change(i), time, body.elements});
    all.so_far_->change(i, time);
    body.elements = elements;
    if (!all.lists_->changed(i, time)) {
      if (is_last())
        all.lists_->list_anew(i);
      else
        leaves_slack = true;
    }
  }

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

bool OptimisticLoop::carry_out(const StepAtHand& step, Particles& particles, StepSoFar& so_far, const Finder& finder,
                               NeighbourLists& lists, const std::vector<Event>& first, std::size_t domains) {
  assert(finder.exact() && domains > 0 && domains <= most_domains);
  step_ = &step;
  particles_ = &particles;
  so_far_ = &so_far;
  finder_ = &finder;
  lists_ = &lists;
  across_ = domains;
  cut(first);
  for (std::size_t round = 0; round < rounds; ++round) {
    if (round == 0)
      run(round, first);
    else
      run(round, left_by(round - 1));
    if (std::any_of(domains_.begin(), domains_.end(), [](const Domain& d) { return d.failed; }))
      return roll_back_all();
  }
  return put_in_order() || roll_back_all();
}

// Where the first contacts are tells where to cut, so that each domain has as many.
void OptimisticLoop::cut(const std::vector<Event>& first) {
  constexpr std::size_t enough = 64;                                                      // for a domain
  const std::size_t stride = 1 + first.size() / (enough * across_), halves = 2 * across_; // domains are two halves wide
  std::vector<std::uint32_t> across;
  for (std::size_t e = 0; e < first.size(); e += stride) // they are nearly in order across, so few tell
    across.push_back(lists_->across(first[e].low));
  std::sort(across.begin(), across.end());
  edges_.clear();
  for (std::size_t half = 0; half < halves; ++half)
    edges_.push_back(across.empty() ? 0 : across[half * across.size() / halves]);
  if (domains_.size() != halves + 1)
    domains_ = std::vector<Domain>(halves + 1);
  for (std::size_t s = 0; s < halves; ++s) {
    const std::size_t half = 2 * (s % across_) + s / across_;
    domains_[s].begin = edges_[half % halves];
    domains_[s].width = edges_[(half + 2) % halves] - edges_[half % halves];
  }
  newest_.resize(particles_->size());
  barred_.resize(particles_->size());
}

void OptimisticLoop::Domain::clear() {
  given.clear();
  aside.clear();
  deferred.clear();
  barred.clear();
  changes.clear();
  contacts.clear();
  records.clear();
  is_rolled_back.clear();
  unresolved.clear();
  touched.clear();
  most_partners = 0;
  rolled_back = 0;
  failed = false;
}

// Events go to who owns both particles; of the others each owner knows when its particle is not for it any more.
void OptimisticLoop::deal(std::size_t round, std::span<const Event> events) {
  Domain* const own = &domains_[begin_of(round)];
  for (const Event& event : events) {
    const std::size_t low = owner(round, event.low), high = owner(round, event.high);
    if (low == high) {
      own[low].given.push_back(event);
      continue;
    }
    own[low].barred.push_back({event.time, event.low, event.low_stamp});
    own[high].barred.push_back({event.time, event.high, event.high_stamp});
    own[low].aside.push_back(event);
  }
}

void OptimisticLoop::run(std::size_t round, const std::vector<Event>& events) {
  const std::size_t begin = begin_of(round);
  for (std::size_t s = begin; s < (round == 0 ? domains_.size() : end_of(round)); ++s)
    domains_[s].clear();
  deal(round, events);
  (round + 1 == rounds ? last_deferred : deferred) += round > 0 ? events.size() : 0;
  parallel_for(
      end_of(round) - begin, [&](std::size_t s) { run(round, domains_[begin + s]); }, 1);
  for (std::size_t s = begin; s < end_of(round); ++s)
    rolled_back += domains_[s].rolled_back;
}

void OptimisticLoop::run(std::size_t round, Domain& domain) {
  const auto own = static_cast<std::size_t>(&domain - &domains_[begin_of(round)]);
  Orbits orbits{*this, domain, round, own, lists_->farthest_across()};
  try {
    std::sort(domain.barred.begin(), domain.barred.end(),
              [](const Barred& a, const Barred& b) { return a.time < b.time; });
    domain.events.assign(domain.given);
    domain.changes.reserve(5 * domain.given.size() / 2);
    ContactLoop loop(*step_, orbits, domain.events);
    if (orbits.is_last()) {
      for (std::size_t s = 0; s + 1 < domains_.size(); ++s)
        orbits.paths.insert(orbits.paths.end(), domains_[s].unresolved.begin(), domains_[s].unresolved.end());
      orbits.resolve();
      loop.search_again(orbits.again);
    }
    loop.run();
    domain.most_partners = loop.most_partners();
  } catch (...) {
    domain.failed = true; // the sequence will throw it in its order
  }
  for (const std::uint32_t i : orbits.barred)
    barred_[i] = 0;
}

std::vector<Event> OptimisticLoop::left_by(std::size_t round) const {
  std::vector<Event> left;
  for (std::size_t s = begin_of(round); s < end_of(round); ++s) {
    left.insert(left.end(), domains_[s].aside.begin(), domains_[s].aside.end());
    left.insert(left.end(), domains_[s].deferred.begin(), domains_[s].deferred.end());
  }
  return left;
}

// The particle has the orbit of before the change again, the last of its changes.
void OptimisticLoop::restore(const Change& change, bool alone) {
  particles_->bodies[change.place].elements = change.ended;
  newest_[change.place] = change.earlier;
  const bool stays = lists_->changed(change.place, change.begin);
  if (!stays && alone) // as the last round has listed it anew since
    lists_->list_anew(change.place);
}

// The domain's last contact, of which nobody knows yet.
void OptimisticLoop::take_back(Domain& domain) {
  domain.contacts.pop_back();
  if (!domain.records.empty())
    domain.records.pop_back();
  domain.is_rolled_back.pop_back();
  for (int both = 0; both < 2; ++both) {
    const Change last = domain.changes.back();
    domain.changes.pop_back();
    so_far_->take_back(last.place, last.begin);
    if (!last.earlier)
      domain.touched.pop_back();
    restore(last, false);
  }
}

// Contacts of one domain are in order, and of the next ones of all domains the one with the smallest key comes first.
// False: of several contacts at one instant a later round has some.
bool OptimisticLoop::put_in_order() {
  std::vector<std::uint32_t> next(domains_.size());
  std::vector<double> times; // of the next ones
  const auto time_of = [&](std::size_t s) {
    const Domain& its = domains_[s];
    while (next[s] < its.contacts.size() && its.is_rolled_back[next[s]])
      ++next[s];
    return next[s] < its.contacts.size() ? its.contacts[next[s]].time : HUGE_VAL;
  };
  const auto ids_of = [&](std::size_t s) {
    const Change* both = &domains_[s].changes[2 * next[s]];
    return std::pair(particles_->ids[both[0].place], particles_->ids[both[1].place]);
  };
  for (std::size_t s = 0; s < domains_.size(); ++s)
    times.push_back(time_of(s));
  order_.clear();
  double last_time = -HUGE_VAL;
  bool last_is_late = false; // some contact at that instant is not of the first round
  for (;;) {
    std::size_t first = 0;
    for (std::size_t s = 1; s < domains_.size(); ++s)
      if (times[s] < times[first] || (times[s] == times[first] && times[s] < HUGE_VAL && ids_of(s) < ids_of(first)))
        first = s;
    const double time = times[first];
    if (time == HUGE_VAL)
      return true;
    const bool is_late = first >= end_of(0);
    if (time == last_time && (is_late || last_is_late))
      return false;
    last_time = time;
    last_is_late = is_late;
    order_.emplace_back(first, next[first]++);
    times[first] = time_of(first);
  }
}

// Everything as at the start of the step.
bool OptimisticLoop::roll_back_all() {
  so_far_->begin_step(particles_->size(), step_->begin);
  for (Domain& domain : domains_) {
    for (const Change& change : domain.changes)
      if (!change.earlier)
        restore(change, true);
    domain.clear();
  }
  return false;
}

std::size_t OptimisticLoop::contacts() const {
  std::size_t count = 0;
  for (const Domain& domain : domains_)
    count += domain.contacts.size() - std::count(domain.is_rolled_back.begin(), domain.is_rolled_back.end(), 1);
  return count;
}

void OptimisticLoop::list_touched(std::vector<std::uint32_t>& touched) const {
  for (const Domain& domain : domains_)
    touched.insert(touched.end(), domain.touched.begin(), domain.touched.end());
}

std::uint64_t OptimisticLoop::most_partners() const {
  std::uint64_t most = 0;
  for (const Domain& domain : domains_)
    most = std::max(most, domain.most_partners);
  return most;
}

std::size_t OptimisticLoop::bytes() const {
  std::size_t total =
      newest_.capacity() * sizeof(std::uint32_t) + barred_.capacity() + order_.capacity() * sizeof(order_[0]);
  for (const Domain& d : domains_)
    total += (d.given.capacity() + d.aside.capacity() + d.deferred.capacity()) * sizeof(Event) + d.events.bytes() +
             d.barred.capacity() * sizeof(Barred) + d.changes.capacity() * sizeof(Change) +
             d.contacts.capacity() * sizeof(Contact) + d.records.capacity() * sizeof(CollisionRecord);
  return total;
}

} // namespace keeler
