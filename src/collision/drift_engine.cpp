#include "drift_engine.hpp"

#include "ablation.hpp"
#include "drift_audit.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/finders/certified_finder.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/certified.hpp>

#include <fmt/format.h>

#include <array>
#include <cassert>

namespace keeler::collision {
namespace {

std::unique_ptr<finders::Finder> finder_named(const std::string& name) {
  if (without(Acceleration::newton))
    return std::make_unique<finders::MotionSearch<finders::BoundedMotion, finders::CertifiedSearch>>();
  if (without(Acceleration::lanes))
    return finders::make_certified_finder(InstructionSet::portable);
  return finders::make_finder(name);
}

// Returns the number of domains that carries out contacts fastest: three per thread, since blocks have different
// numbers of contacts and some threads would wait; and more where contacts are so many, and particles too, that it pays
// to have what a domain touches in the cache of a processor.
std::size_t domains_that_pay(std::size_t particles, std::size_t first_contacts) {
  constexpr std::size_t min_contacts = 50, in_cache = 2500; // of a domain
  const bool crowded = particles >= 16 * in_cache && first_contacts >= particles / 25;
  const auto several = static_cast<std::size_t>(threads());
  const std::size_t domains = std::max(several > 1 ? 3 * several : 1, crowded ? particles / in_cache : 1);
  return std::min(domains, first_contacts / min_contacts);
}

constexpr std::size_t searches_together = 64;

// What some contacts of a step, which follow each other, did.
struct Counted {
  StepOutcome outcome;
  CollisionTally tally;
  DriftCosts costs;

  void operator+=(const Counted& later) {
    outcome.append(later.outcome);
    add_counts(later, tally, costs);
  }
  static void add_counts(const Counted& counted, CollisionTally& tally, DriftCosts& costs) {
    tally.fast += counted.tally.fast;
    tally.slow += counted.tally.slow;
    tally.unresolved += counted.tally.unresolved;
    costs.contacts += counted.costs.contacts;
    costs.recontacts += counted.costs.recontacts;
  }
};

// The first contacts of a block of candidates.
struct FirstContacts {
  std::vector<Event> events;
  std::uint64_t gave_up = 0;
  bool has_not_a_number = false;
};

// Asks the finder about some candidates at once. `own`: see ContactCounter.
void search_some(const StepContext& step, std::span<const Candidate> candidates, std::size_t own,
                 FirstContacts& found) {
  assert(candidates.size() <= searches_together);
  std::array<finders::Query, searches_together> queries;
  std::array<finders::FinderResult, searches_together> results;
  const std::size_t count = candidates.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Candidate& c = candidates[k];
    const Vec3 shift = step.box.displacement(c.image, step.offset);
    queries[k] = {c.low, c.high, shift.x(), shift.y(), step.begin};
  }
  step.finder.find_all(std::span(queries).first(count), std::span(results).first(count));
  const std::vector<std::uint64_t>& ids = step.particles.ids;
  for (std::size_t k = 0; k < count; ++k) {
    const Candidate& c = candidates[k];
    const finders::FinderResult& result = results[k];
    if (step.watcher)
      step.watcher->searched(queries[k], result);
    if (result.contact())
      found.events.push_back({result.time, ids[c.low], ids[c.high], c.image, c.low, c.high, 0, 0});
    found.gave_up += result.exit == finders::FinderExit::gave_up && c.low < own;
    found.has_not_a_number |= result.exit == finders::FinderExit::not_a_number;
  }
}

} // namespace

DriftEngine::DriftEngine(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                         double step)
    : settings_(settings), frequencies_(frequencies), orbital_frequency_(orbital_frequency), schedule_{step},
      finder_(finder_named(settings.finder)), broad_phase_(frequencies, step),
      finder_step_(frequencies, -0.5 * step, 0.5 * step, 0.0) {
  assert(step > 0.0);
  if (!finder_)
    throw UsageError(fmt::format("unknown collision finder '{}'", settings.finder));
}

void DriftEngine::set_step(double step, double kick_pull, double rest_pull) {
  assert(step > 0.0 && kick_pull >= 0.0 && rest_pull >= 0.0);
  if (step != schedule_.step)
    broad_phase_.set_step(step);
  schedule_ = {step, kick_pull, rest_pull};
}

void DriftEngine::collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally,
                          bool undisturbed, const KickInterval& gravity) {
  const StepContext step = context_of(particles, box, offset, gravity);
  begin_step(step, undisturbed);
  if (audit_)
    audit_begin(*audit_, step, finder_step_.straight_line, candidates_);
  const std::vector<Event> first = solve(step, ContactCounter::all_particles);
  {
    const Stopwatch stopwatch(costs_.events);
    const ContactCounter counter{outcome_, tally, costs_};
    if (!carry_out_in_domains(step, first, counter)) {
      SequentialOrbits orbits(step, history_, broad_phase_, counter);
      carry_out_in_sequence(step, first, orbits);
    }
  }
  if (audit_)
    audit_end(*audit_, step, finder_step_.straight_line, broad_phase_, history_, outcome_.dirty);
  outcome_.add_sums_to(tally);
  end_step(step);
}

StepContext DriftEngine::context_of(Particles& particles, const ShearingBox& box, double offset,
                                    const KickInterval& gravity) const {
  assert(gravity.accelerations.empty() || gravity.accelerations.size() == particles.size());
  assert(particles.ids.size() == particles.size() && (!particles.rough || particles.spins.size() == particles.size()));
  return {.particles = particles,
          .settings = settings_,
          .finder = finder(),
          .frequencies = frequencies_,
          .orbital_frequency = orbital_frequency_,
          .box = box,
          .offset = offset,
          .begin = -0.5 * schedule_.step,
          .kick_pull = schedule_.kick_pull,
          .rest_pull = schedule_.rest_pull,
          .gravity = gravity,
          .watcher = observer_ && observer_->wants_events() ? observer_ : nullptr,
          .record_taker = observer_ && observer_->wants_records() ? observer_ : nullptr};
}

void DriftEngine::begin_step(const StepContext& step, bool undisturbed) {
  const bool every_candidate = observer_ && observer_->wants_every_candidate();
  {
    const Stopwatch stopwatch(costs_.build);
    ++costs_.steps;
    outcome_.clear();
    history_.begin_step(step.particles.size(), step.begin);
    const bool exactly = step.watcher || !step.finder.exact();
    broad_phase_.begin(step.particles, step.box, step.offset, undisturbed, every_candidate, exactly);
    finder_step_ = finders::DriftStep(frequencies_, step.begin, step.end(), step.box.size_x + step.box.size_y);
    finder_step_.bodies = step.particles.bodies;
    finder_step_.tested = !every_candidate && !without(Acceleration::rejection);
    step.finder.begin(finder_step_);
    if (step.watcher)
      step.watcher->begins(finder_step_);
  }
  find_candidates(step);
}

// Collects the pairs that the finder must be asked about, block by block.
void DriftEngine::find_candidates(const StepContext& step) {
  const Stopwatch stopwatch(costs_.reject);
  const std::vector<std::uint64_t>& ids = step.particles.ids;
  candidates_.resize(broad_phase_.blocks());
  parallel_for(
      candidates_.size(),
      [&](std::size_t b) {
        candidates_[b].clear();
        broad_phase_.visit_block(b, [&](std::size_t i, std::size_t j, const Image& image) {
          const auto a = static_cast<std::uint32_t>(i), b2 = static_cast<std::uint32_t>(j);
          const bool ordered = ids[i] < ids[j];
          candidates_[b].push_back(ordered ? Candidate{a, b2, image} : Candidate{b2, a, -image});
        });
      },
      1);
  for (const std::vector<Candidate>& block : candidates_)
    costs_.survivors += block.size();
  if (step.watcher && !step.watcher->wants_every_candidate()) { // lists and threads must not show in what is watched
    for (std::size_t b = 1; b < candidates_.size(); ++b)
      candidates_[0].insert(candidates_[0].end(), candidates_[b].begin(), candidates_[b].end());
    candidates_.resize(std::min<std::size_t>(candidates_.size(), 1));
    for (std::vector<Candidate>& all : candidates_)
      sort_by_ids(all, ids);
  }
}

// Returns the first contact of each candidate pair. Blocks are joined in order, so threads do not matter.
std::vector<Event> DriftEngine::solve(const StepContext& step, std::size_t own) {
  const Stopwatch stopwatch(costs_.solve);
  std::vector<FirstContacts> found(candidates_.size());
  const auto search_block = [&](std::size_t b) {
    const std::span<const Candidate> block = candidates_[b];
    for (std::size_t k = 0; k < block.size() && !interrupted(); k += searches_together)
      search_some(step, block.subspan(k, std::min(searches_together, block.size() - k)), own, found[b]);
  };
  if (step.watcher)
    for (std::size_t b = 0; b < found.size(); ++b)
      search_block(b);
  else
    parallel_for(found.size(), search_block, 1);
  throw_if_interrupted();
  std::size_t events = 0;
  for (const FirstContacts& f : found)
    events += f.events.size();
  std::vector<Event> all;
  all.reserve(events);
  for (const FirstContacts& f : found) {
    all.insert(all.end(), f.events.begin(), f.events.end());
    outcome_.gave_up += f.gave_up;
    if (f.has_not_a_number)
      throw InvariantError("a collision search met numbers that are not finite");
  }
  return all;
}

// Carries out all contacts in domains, where that cannot show in the result and pays.
// Otherwise returns false, with everything as it was.
bool DriftEngine::carry_out_in_domains(const StepContext& step, const std::vector<Event>& first,
                                       const ContactCounter& counter) {
  if (broad_phase_.through_grid() || step.watcher || !step.finder.exact())
    return false;
  const std::size_t wanted = observer_ ? observer_->wants_domains() : 0;
  const std::size_t domains = std::min(OptimisticLoop::max_domains,
                                       wanted > 0 ? wanted : domains_that_pay(step.particles.size(), first.size()));
  if (domains < 2 || !optimistic_.carry_out(step, history_, broad_phase_.lists(), first, domains))
    return false;
  count_contacts(step, counter);
  optimistic_.append_dirty(outcome_.dirty);
  costs_.widest_list = std::max(costs_.widest_list, optimistic_.max_partners());
  return true;
}

// Adds the contacts that were carried out in domains.
void DriftEngine::count_contacts(const StepContext& step, const ContactCounter& counter) {
  const auto all = ordered_total<Counted>(optimistic_.contacts(), [&](Counted& counted, std::size_t k) {
    const ContactCounter some{counted.outcome, counted.tally, counted.costs, counter.own};
    if (some.add(optimistic_.contact(k)) && step.record_taker)
      counted.outcome.records.push_back(*optimistic_.record(k));
  });
  counter.outcome.append(all.outcome);
  Counted::add_counts(all, counter.tally, counter.costs);
}

void DriftEngine::end_step(const StepContext& step) {
  broad_phase_.end(outcome_.dirty);
  if (step.record_taker)
    step.record_taker->recorded(outcome_.records);
  if (step.particles.size())
    costs_.bytes_per_particle = bytes(step) / step.particles.size();
}

double DriftEngine::reached() const {
  double latest = -0.5 * schedule_.step;
  for (const std::uint32_t i : outcome_.dirty)
    latest = std::max(latest, history_.last_change(i));
  return latest;
}

DriftCosts DriftEngine::costs() const {
  DriftCosts costs = costs_;
  const NeighbourLists& lists = broad_phase_.lists();
  costs.lists_made = lists.counts().rebuilds;
  costs.pairs_tested = lists.counts().tested;
  costs.listed = lists.counts().listed;
  costs.lists_rebuilt = lists.counts().renewed;
  costs.deferred = optimistic_.counts().deferred;
  costs.in_sequence = optimistic_.counts().last_deferred;
  costs.rolled_back = optimistic_.counts().rolled_back;
  costs.abandoned = optimistic_.counts().abandoned;
  return costs;
}

std::size_t DriftEngine::bytes(const StepContext& step) const {
  const Particles& particles = step.particles;
  std::size_t total =
      sizeof(*this) + particles.bodies.capacity() * sizeof(Body) + particles.ids.capacity() * sizeof(std::uint64_t);
  total += broad_phase_.lists().bytes() + optimistic_.bytes() + events_.bytes() + history_.bytes();
  total += outcome_.dirty.capacity() * sizeof(std::uint32_t);
  total += particles.size() * step.finder.bytes_per_particle();
  for (const std::vector<Candidate>& block : candidates_)
    total += block.capacity() * sizeof(Candidate) + sizeof(std::vector<Candidate>);
  return total;
}

} // namespace keeler::collision
