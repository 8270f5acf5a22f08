#include "optimistic_loop.hpp"

#include "optimistic_orbits.hpp"

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {

bool OptimisticLoop::carry_out(const StepAtHand& step, Particles& particles, StepSoFar& so_far, const Finder& finder,
                               NeighbourLists& lists, const std::vector<Event>& first, std::size_t domains) {
  assert(finder.exact() && domains > 0 && domains <= max_domains);
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
  spins.clear();
  contacts.clear();
  records.clear();
  is_rolled_back.clear();
  unresolved.clear();
  touched.clear();
  max_partners = 0;
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
    domain.changes.reserve(9 * domain.given.size() / 4);
    ContactLoop loop(*step_, orbits, domain.events);
    if (orbits.is_last()) {
      for (std::size_t s = 0; s + 1 < domains_.size(); ++s)
        orbits.paths.insert(orbits.paths.end(), domains_[s].unresolved.begin(), domains_[s].unresolved.end());
      orbits.resolve();
      loop.search_again(orbits.again);
    }
    loop.run();
    domain.max_partners = loop.max_partners();
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

// The particle has the orbit and the spin of before the domain's change of that number again, the last of its changes.
void OptimisticLoop::restore(const Domain& domain, std::size_t number, bool alone) {
  const Change& change = domain.changes[number];
  particles_->bodies[change.place].elements = change.ended;
  if (particles_->rough)
    particles_->spins[change.place] = domain.spins[number];
  newest_[change.place] = change.earlier;
  const bool stays = lists_->changed(change.place, change.begin);
  if (!stays && alone) // as the last round has listed it anew since
    lists_->rebuild_list(change.place);
}

// The domain's last contact, of which nobody knows yet.
void OptimisticLoop::take_back(Domain& domain) {
  domain.contacts.pop_back();
  if (!domain.records.empty())
    domain.records.pop_back();
  domain.is_rolled_back.pop_back();
  for (int both = 0; both < 2; ++both) {
    const Change& last = domain.changes.back();
    so_far_->take_back(last.place, last.begin);
    if (!last.earlier)
      domain.touched.pop_back();
    restore(domain, domain.changes.size() - 1, false);
    domain.changes.pop_back();
    if (particles_->rough)
      domain.spins.pop_back();
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
    for (std::size_t k = 0; k < domain.changes.size(); ++k)
      if (!domain.changes[k].earlier)
        restore(domain, k, true);
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

std::uint64_t OptimisticLoop::max_partners() const {
  std::uint64_t most = 0;
  for (const Domain& domain : domains_)
    most = std::max(most, domain.max_partners);
  return most;
}

std::size_t OptimisticLoop::bytes() const {
  std::size_t total = newest_.capacity() * sizeof(std::uint32_t) + barred_.capacity() +
                      order_.capacity() * sizeof(order_[0]) + domains_.capacity() * sizeof(Domain);
  for (const Domain& d : domains_)
    total += (d.given.capacity() + d.aside.capacity() + d.deferred.capacity()) * sizeof(Event) + d.events.bytes() +
             d.barred.capacity() * sizeof(Barred) + d.changes.capacity() * sizeof(Change) +
             d.spins.capacity() * sizeof(Vec3) + d.contacts.capacity() * sizeof(Contact) +
             d.records.capacity() * sizeof(CollisionRecord) + d.is_rolled_back.capacity() +
             d.touched.capacity() * sizeof(std::uint32_t);
  return total;
}

} // namespace keeler
