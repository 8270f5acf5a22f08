#include "optimistic_loop.hpp"

#include "optimistic_orbits.hpp"

#include <keeler/core/counting_sort.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::collision {

void OptimisticDomain::clear() {
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
  return deferred.capacity() * sizeof(Event) + lock_schedule.bytes() + contacts.bytes() +
         unresolved.capacity() * sizeof(NewPath) + dirty.capacity() * sizeof(std::uint32_t);
}

bool OptimisticLoop::carry_out(const StepContext& context, StepHistory& history, NeighbourLists& lists,
                               const std::vector<Event>& first, std::size_t domains) {
  assert(context.finder.exact() && domains > 0 && domains <= max_domains);
  const Step step{context, history, lists};
  begin_step(step, domains);
  for (std::size_t round = 0; round < DomainCut::rounds; ++round) {
    if (round == 0)
      run_round(step, round, first);
    else
      run_round(step, round, left_by(round - 1));
    if (std::any_of(state_.domains.begin(), state_.domains.end(), [](const OptimisticDomain& d) { return d.failed; }))
      return abandon(step);
  }
  return order_.sort(state_.domains, state_.cut.end_of(0), context) || abandon(step);
}

void OptimisticLoop::begin_step(const Step& step, std::size_t domains) {
  const ShearingBox& box = step.context.box;
  state_.cut.cut(domains, box.size_x / box.size_y, step.lists.offset_along());
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

// Assigns each event to the domains that own its particles.
void OptimisticLoop::assign(const Step& step, std::size_t round, std::span<const Event> events) {
  const std::size_t domains = state_.cut.end_of(round) - state_.cut.begin_of(round), none = domains;
  std::vector<std::uint32_t> owners(2 * events.size()); // of the lower id; of the higher id if that is another domain
  parallel_for(events.size(), [&](std::size_t e) {
    const std::size_t low = owner(step, round, events[e].low), high = owner(step, round, events[e].high);
    owners[2 * e] = static_cast<std::uint32_t>(low);
    owners[2 * e + 1] = static_cast<std::uint32_t>(low == high ? none : high);
  });
  assigned_.resize(owners.size());
  counting_sort(owners, domains + 1, assigned_begins_,
                [&](std::size_t k, std::size_t position) { assigned_[position] = static_cast<std::uint32_t>(k / 2); });
}

// Returns the assigned events of which the domain owns both particles. Of others it locks its particle from then on.
std::vector<Event> OptimisticLoop::own_events(const Step& step, std::size_t round, std::size_t number,
                                              std::span<const Event> events) {
  OptimisticDomain& domain = state_.domains[number];
  const std::size_t own = number - state_.cut.begin_of(round);
  std::vector<Event> both;
  for (std::size_t k = assigned_begins_[own]; k < assigned_begins_[own + 1]; ++k) {
    const Event& event = events[assigned_[k]];
    const bool owns_low = owner(step, round, event.low) == own, owns_high = owner(step, round, event.high) == own;
    if (owns_low && owns_high) {
      both.push_back(event);
    } else if (owns_low) {
      domain.lock_schedule.add(event.time, event.low, event.low_count);
      domain.deferred.push_back(event);
    } else {
      domain.lock_schedule.add(event.time, event.high, event.high_count);
    }
  }
  domain.lock_schedule.sort();
  return both;
}

void OptimisticLoop::run_round(const Step& step, std::size_t round, const std::vector<Event>& events) {
  const std::size_t begin = state_.cut.begin_of(round), end = state_.cut.end_of(round);
  assign(step, round, events);
  counts_.deferred += round == 1 ? events.size() : 0;
  counts_.last_deferred += round + 1 == DomainCut::rounds ? events.size() : 0;
  const std::vector<NewPath> unresolved = take_unresolved(begin);
  parallel_for(
      end - begin, [&](std::size_t k) { run_domain(step, round, begin + k, events, unresolved); }, 1);
  for (std::size_t d = begin; d < end; ++d)
    counts_.rolled_back += state_.domains[d].rolled_back;
}

void OptimisticLoop::run_domain(const Step& step, std::size_t round, std::size_t number, std::span<const Event> events,
                                std::span<const NewPath> unresolved) {
  OptimisticDomain& domain = state_.domains[number];
  const DomainScope scope(state_.cut, step.lists, round, number);
  DomainOrbits orbits(step.context, step.history, step.lists, state_, scope);
  try {
    EventQueue queue;
    queue.assign(own_events(step, round, number, events));
    ContactLoop loop(step.context, orbits, queue);
    orbits.resolve(unresolved);
    loop.predict_again(orbits.reinstated());
    loop.run();
    domain.max_partners = loop.max_partners();
  } catch (...) {
    domain.failed = true; // the sequential loop will throw it in its order
  }
}

// Returns the paths that the domains before `end` have left.
std::vector<NewPath> OptimisticLoop::take_unresolved(std::size_t end) {
  std::vector<NewPath> unresolved;
  for (std::size_t d = 0; d < end; ++d) {
    std::vector<NewPath>& left = state_.domains[d].unresolved;
    unresolved.insert(unresolved.end(), left.begin(), left.end());
    left.clear();
  }
  return unresolved;
}

std::vector<Event> OptimisticLoop::left_by(std::size_t round) const {
  std::vector<Event> left;
  for (std::size_t d = state_.cut.begin_of(round); d < state_.cut.end_of(round); ++d) {
    const OptimisticDomain& domain = state_.domains[d];
    left.insert(left.end(), domain.deferred.begin(), domain.deferred.end());
  }
  return left;
}

// Restores everything as at the start of the step: the first change of each particle ended the path of then.
void OptimisticLoop::roll_back_all(const Step& step) {
  step.history.begin_step(step.context.particles.size(), step.context.begin);
  for (std::size_t d = 0; d < state_.domains.size(); ++d) {
    for (std::size_t k = 0; k < state_.log.size(d); ++k)
      if (const ChangeNumber number = ChangeLog::number_of(d, k); !state_.log[number].earlier)
        restore_path(number, step.context.particles, state_.log, step.lists, true);
    state_.log.clear(d);
    state_.domains[d].clear();
  }
}

// Leaves all contacts of the step to the sequential loop: returns false.
bool OptimisticLoop::abandon(const Step& step) {
  roll_back_all(step);
  ++counts_.abandoned;
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

void OptimisticLoop::release() {
  state_ = OptimisticState();
  free_memory(assigned_);
  free_memory(assigned_begins_);
  order_ = ContactOrder();
}

std::size_t OptimisticLoop::bytes() const {
  std::size_t total = state_.log.bytes() + state_.locks.bytes() + order_.bytes() +
                      state_.domains.capacity() * sizeof(OptimisticDomain) +
                      (assigned_.capacity() + assigned_begins_.capacity()) * sizeof(std::uint32_t);
  for (const OptimisticDomain& domain : state_.domains)
    total += domain.bytes();
  return total;
}

} // namespace keeler::collision
