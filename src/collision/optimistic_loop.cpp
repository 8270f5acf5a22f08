#include "optimistic_loop.hpp"

#include "optimistic_orbits.hpp"

#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::collision {

void OptimisticDomain::clear() {
  assigned.clear();
  cross_domain.clear();
  deferred.clear();
  lock_schedule.clear();
  contacts.clear();
  unresolved.clear();
  dirty.clear();
  max_partners = 0;
  rolled_back = 0;
  failed = false;
}

std::size_t OptimisticDomain::bytes() const {
  return (assigned.capacity() + cross_domain.capacity() + deferred.capacity()) * sizeof(Event) + events.bytes() +
         lock_schedule.bytes() + contacts.bytes() + dirty.capacity() * sizeof(std::uint32_t);
}

bool OptimisticLoop::carry_out(const StepContext& context, StepHistory& history, NeighbourLists& lists,
                               const std::vector<Event>& first, std::size_t domains) {
  assert(context.finder.exact() && domains > 0 && domains <= max_domains);
  const Step step{context, history, lists};
  begin_step(step, first, domains);
  for (std::size_t round = 0; round < DomainCut::rounds; ++round) {
    if (round == 0)
      run_round(step, round, first);
    else
      run_round(step, round, left_by(round - 1));
    if (std::any_of(state_.domains.begin(), state_.domains.end(), [](const OptimisticDomain& d) { return d.failed; }))
      return roll_back_all(step);
  }
  return merge_contacts(context.particles) || roll_back_all(step);
}

// Cuts the box so that each domain has an equal number of the first contacts.
void OptimisticLoop::begin_step(const Step& step, const std::vector<Event>& first, std::size_t domains) {
  constexpr std::size_t samples = 64; // per domain; contacts are nearly sorted across the box, so few suffice
  const std::size_t stride = 1 + first.size() / (samples * domains);
  std::vector<std::uint32_t> across;
  for (std::size_t e = 0; e < first.size(); e += stride)
    across.push_back(step.lists.across(first[e].low));
  state_.cut.cut(std::move(across), domains);
  const std::size_t all = state_.cut.domains(), particles = step.context.particles.size();
  if (state_.domains.size() != all)
    state_.domains = std::vector<OptimisticDomain>(all);
  state_.log.resize(particles, all);
  state_.locks.resize(particles);
  for (std::size_t d = 0; d < all; ++d) {
    state_.domains[d].clear();
    state_.log.clear(d);
  }
}

// Gives each event to the domain that owns both particles. Of other events, each of the two owners locks its particle
// from then on.
void OptimisticLoop::assign(const Step& step, std::size_t round, std::span<const Event> events) {
  OptimisticDomain* const domains = &state_.domains[state_.cut.begin_of(round)];
  const auto owner = [&](std::uint32_t i) { return state_.cut.owner(round, step.lists.across(i)); };
  for (const Event& event : events) {
    const std::size_t low = owner(event.low), high = owner(event.high);
    if (low == high) {
      domains[low].assigned.push_back(event);
      continue;
    }
    domains[low].lock_schedule.add(event.time, event.low, event.low_count);
    domains[high].lock_schedule.add(event.time, event.high, event.high_count);
    domains[low].cross_domain.push_back(event);
  }
}

void OptimisticLoop::run_round(const Step& step, std::size_t round, const std::vector<Event>& events) {
  const std::size_t begin = state_.cut.begin_of(round), end = state_.cut.end_of(round);
  assign(step, round, events);
  (round + 1 == DomainCut::rounds ? counts_.last_deferred : counts_.deferred) += round > 0 ? events.size() : 0;
  parallel_for(
      end - begin, [&](std::size_t k) { run_domain(step, round, begin + k); }, 1);
  for (std::size_t d = begin; d < end; ++d)
    counts_.rolled_back += state_.domains[d].rolled_back;
}

void OptimisticLoop::run_domain(const Step& step, std::size_t round, std::size_t number) {
  OptimisticDomain& domain = state_.domains[number];
  const DomainScope scope(state_.cut, step.lists, round, number);
  DomainOrbits orbits(step.context, step.history, step.lists, state_, scope);
  try {
    domain.lock_schedule.sort();
    domain.events.assign(domain.assigned);
    state_.log.reserve(number, 9 * domain.assigned.size() / 4);
    ContactLoop loop(step.context, orbits, domain.events);
    if (scope.is_last()) {
      std::vector<NewPath> unresolved;
      for (std::size_t d = 0; d < number; ++d)
        unresolved.insert(unresolved.end(), state_.domains[d].unresolved.begin(), state_.domains[d].unresolved.end());
      orbits.resolve(unresolved);
      loop.predict_again(orbits.reinstated());
    }
    loop.run();
    domain.max_partners = loop.max_partners();
  } catch (...) {
    domain.failed = true; // the sequential loop will throw it in its order
  }
}

std::vector<Event> OptimisticLoop::left_by(std::size_t round) const {
  std::vector<Event> left;
  for (std::size_t d = state_.cut.begin_of(round); d < state_.cut.end_of(round); ++d) {
    const OptimisticDomain& domain = state_.domains[d];
    left.insert(left.end(), domain.cross_domain.begin(), domain.cross_domain.end());
    left.insert(left.end(), domain.deferred.begin(), domain.deferred.end());
  }
  return left;
}

// Merges the domains' sorted contacts by (time, ids). Returns false if contacts at one instant include one of a later
// round.
bool OptimisticLoop::merge_contacts(const Particles& particles) {
  const std::size_t domains = state_.domains.size();
  std::vector<std::size_t> next(domains);
  std::vector<double> times; // of the next contacts
  const auto advance_to = [&](std::size_t d, std::size_t contact) {
    const DomainContacts& log = state_.domains[d].contacts;
    next[d] = log.next_valid(contact);
    return next[d] < log.size() ? log[next[d]].time : HUGE_VAL;
  };
  const auto ids_of = [&](std::size_t d) {
    const Contact& contact = state_.domains[d].contacts[next[d]];
    return std::pair(particles.ids[contact.low], particles.ids[contact.high]);
  };
  for (std::size_t d = 0; d < domains; ++d)
    times.push_back(advance_to(d, 0));
  order_.clear();
  double last_time = -HUGE_VAL;
  bool last_is_late = false; // a contact at that instant is not of the first round
  for (;;) {
    std::size_t first = 0;
    for (std::size_t d = 1; d < domains; ++d)
      if (times[d] < times[first] || (times[d] == times[first] && times[d] < HUGE_VAL && ids_of(d) < ids_of(first)))
        first = d;
    const double time = times[first];
    if (time == HUGE_VAL)
      return true;
    assert(time >= last_time);
    const bool is_late = first >= state_.cut.end_of(0);
    if (time == last_time && (is_late || last_is_late))
      return false;
    last_time = time;
    last_is_late = is_late;
    order_.emplace_back(first, next[first]);
    times[first] = advance_to(first, next[first] + 1);
  }
}

// Restores everything as at the start of the step: the first change of each particle ended the path of then.
bool OptimisticLoop::roll_back_all(const Step& step) {
  step.history.begin_step(step.context.particles.size(), step.context.begin);
  for (std::size_t d = 0; d < state_.domains.size(); ++d) {
    for (std::size_t k = 0; k < state_.log.size(d); ++k)
      if (const ChangeNumber number = ChangeLog::number_of(d, k); !state_.log[number].earlier)
        restore_path(number, step.context.particles, state_.log, step.lists, true);
    state_.log.clear(d);
    state_.domains[d].clear();
  }
  return false;
}

void OptimisticLoop::append_dirty(std::vector<std::uint32_t>& dirty) const {
  for (const OptimisticDomain& domain : state_.domains)
    dirty.insert(dirty.end(), domain.dirty.begin(), domain.dirty.end());
}

std::uint64_t OptimisticLoop::max_partners() const {
  std::uint64_t most = 0;
  for (const OptimisticDomain& domain : state_.domains)
    most = std::max(most, domain.max_partners);
  return most;
}

std::size_t OptimisticLoop::bytes() const {
  std::size_t total = state_.log.bytes() + state_.locks.bytes() + order_.capacity() * sizeof(order_[0]) +
                      state_.domains.capacity() * sizeof(OptimisticDomain);
  for (const OptimisticDomain& domain : state_.domains)
    total += domain.bytes();
  return total;
}

} // namespace keeler::collision
