#include "drift_engine.hpp"

#include "ablation.hpp"
#include "in_place.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/finders/certified_finder.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/certified.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace keeler {
namespace {

std::unique_ptr<Finder> finder_named(const std::string& name) {
  if (without(Acceleration::newton))
    return std::make_unique<MotionSearch<BoundedMotion, CertifiedSearch>>();
  if (without(Acceleration::lanes))
    return make_certified_finder(InstructionSet::portable);
  return make_finder(name);
}

} // namespace

DriftEngine::DriftEngine(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                         double step)
    : settings_(settings), frequencies_(frequencies), orbital_frequency_(orbital_frequency), step_(step),
      finder_(finder_named(settings.finder)), finder_step_(frequencies, -0.5 * step, 0.5 * step, 0.0),
      lists_(frequencies, step), grid_(frequencies, step) {
  if (!finder_)
    throw UsageError(fmt::format("unknown collision finder '{}'", settings.finder));
}

void DriftEngine::set_pace(double step, double kick_pull, double rest_pull) {
  kick_pull_ = kick_pull;
  rest_pull_ = rest_pull;
  if (step == step_)
    return;
  step_ = step;
  lists_.set_step(step);
  grid_ = GridPartners(frequencies_, step);
}

void DriftEngine::collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally,
                          bool undisturbed) {
  begin_step(particles, box, offset, undisturbed);
  if (audit_)
    audit_beginning();
  carry_out(solve(), tally);
  if (audit_)
    audit_end();
  add_sums(tally);
  end_step();
}

void DriftEngine::begin_step(Particles& particles, const ShearingBox& box, double offset, bool undisturbed) {
  touched_.clear();
  particles_ = &particles;
  step_at_hand_ = {&particles, &settings_,   frequencies_, orbital_frequency_, box,
                   offset,     -0.5 * step_, false,        kick_pull_,         rest_pull_};
  gave_up_ = 0;
  sums_ = {};
  slow_pairs_.clear();
  prepare(undisturbed);
  reject();
}

// All that follows from the first contacts.
void DriftEngine::carry_out(const std::vector<Event>& first, CollisionTally& tally) {
  const Stopwatch stopwatch(costs_.events);
  if (in_domains(first, tally))
    return;
  events_.assign(first);
  InPlace orbits{*this, tally};
  ContactLoop loop(step_at_hand_, orbits, events_);
  loop.run();
  costs_.widest_list = std::max(costs_.widest_list, loop.max_partners());
}

void DriftEngine::end_step() {
  if (!through_grid_)
    lists_.mark_dirty(touched_);
  if (takes_records_)
    takes_records_->recorded(records_);
  if (particles_->size())
    costs_.bytes_per_particle = bytes() / particles_->size();
  particles_ = nullptr; // the caller's, who may move it
}

// Whether it is this rank's.
bool DriftEngine::count(const Contact& contact, CollisionTally& tally) {
  if (Communicator::possible && contact.low >= counted_)
    return false; // a copy: its owner counts
  ++(contact.fast ? tally.fast : tally.slow);
  tally.unresolved += contact.unresolved;
  sums_.energy_lost += contact.energy_lost;
  sums_.momentum_flux += contact.momentum_flux;
  sums_.azimuthal_gain += contact.azimuthal_gain;
  ++costs_.contacts;
  costs_.recontacts += contact.again;
  if (contact.slow > 0.0F)
    slow_pairs_.push_back({contact.low, contact.high, contact.slow});
  return true;
}

void DriftEngine::add_sums(CollisionTally& tally) const {
  tally.gave_up += gave_up_;
  tally.energy_lost += sums_.energy_lost.value();
  tally.momentum_flux += sums_.momentum_flux.value();
  tally.azimuthal_gain += sums_.azimuthal_gain.value();
}

// On several threads, when the result cannot tell and there are enough contacts for each.
bool DriftEngine::in_domains(const std::vector<Event>& first, CollisionTally& tally) {
  constexpr std::size_t fewest_contacts = 50; // of a domain
  if (through_grid_ || watch_ || !finder().exact())
    return false;
  const std::size_t paying = std::min(static_cast<std::size_t>(threads()), first.size() / fewest_contacts);
  const std::size_t wanted = observer_ ? observer_->wants_domains() : 0;
  const std::size_t domains = std::min(OptimisticLoop::max_domains, wanted > 0 ? wanted : paying);
  if (domains < 2 || !optimistic_.carry_out(step_at_hand_, *particles_, so_far_, finder(), lists_, first, domains))
    return false;
  optimistic_.visit_contacts([&](const Contact& contact, const CollisionRecord* record) {
    if (count(contact, tally) && takes_records_)
      records_.push_back(*record);
  });
  optimistic_.list_touched(touched_);
  if constexpr (Communicator::possible)
    if (borders_)
      note_changes_of_domains();
  costs_.widest_list = std::max(costs_.widest_list, optimistic_.max_partners());
  return true;
}

void DriftEngine::prepare(bool undisturbed) {
  const Stopwatch stopwatch(costs_.build);
  ++costs_.steps;
  so_far_.begin_step(particles_->size(), -0.5 * step_);
  const ShearingBox& box = step_at_hand_.box;
  const bool every_candidate = observer_ && observer_->wants_every_candidate();
  watch_ = observer_ && observer_->looks_on() ? observer_ : nullptr;
  takes_records_ = observer_ && observer_->wants_records() ? observer_ : nullptr;
  step_at_hand_.recorded = watch_ || takes_records_;
  records_.clear();
  if (every_candidate)
    lists_.release();
  through_grid_ = every_candidate || !lists_.begin(*particles_, box, step_at_hand_.offset, undisturbed);
  lists_.visit_exactly(watch_ || !finder().exact());
  if (through_grid_)
    grid_.begin(*particles_, box, step_at_hand_.offset, every_candidate);
  finder_step_ = DriftStep(frequencies_, -0.5 * step_, 0.5 * step_, box.size_x + box.size_y);
  finder_step_.bodies = particles_->bodies;
  finder_step_.tested = !every_candidate && !without(Acceleration::rejection);
  finder().begin(finder_step_);
  if (watch_)
    watch_->begins(finder_step_);
}

template<class Body> void DriftEngine::for_each_block(const Body& body) const {
  parallel_for(candidates_.size(), body, 1);
}

// The pairs that the finder has to be asked about, block by block.
void DriftEngine::reject() {
  const Stopwatch stopwatch(costs_.reject);
  candidates_.resize(through_grid_ ? grid_.blocks() : lists_.blocks());
  for_each_block([&](std::size_t b) {
    candidates_[b].clear();
    const auto keep = [&](std::size_t i, std::size_t j, const Image& image) {
      const auto a = static_cast<std::uint32_t>(i), b2 = static_cast<std::uint32_t>(j);
      const bool ordered = particles_->ids[i] < particles_->ids[j];
      candidates_[b].push_back(ordered ? Candidate{a, b2, image} : Candidate{b2, a, -image});
    };
    if (through_grid_)
      grid_.visit_block(b, keep);
    else
      lists_.visit_block(b, keep);
  });
  for (const std::vector<Candidate>& block : candidates_)
    costs_.survivors += block.size();
  if (watch_ && !watch_->wants_every_candidate()) { // no window and no number of threads shows in what is watched
    for (std::size_t b = 1; b < candidates_.size(); ++b)
      candidates_[0].insert(candidates_[0].end(), candidates_[b].begin(), candidates_[b].end());
    candidates_.resize(std::min<std::size_t>(candidates_.size(), 1));
    for (std::vector<Candidate>& all : candidates_)
      put_in_order(all);
  }
}

void DriftEngine::put_in_order(std::vector<Candidate>& candidates) const {
  const auto key = [&](const Candidate& c) {
    return std::tuple(particles_->ids[c.low], particles_->ids[c.high], c.image.nx, c.image.ny);
  };
  std::sort(candidates.begin(), candidates.end(),
            [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
}

// All contacts as long as nothing has changed. Blocks are joined in order, so threads do not matter.
std::vector<Event> DriftEngine::solve() {
  constexpr std::size_t together = 64; // searches
  const Stopwatch stopwatch(costs_.solve);
  struct Found {
    std::vector<Event> events;
    std::uint64_t gave_up = 0;
    bool broken = false;
  };
  std::vector<Found> found(candidates_.size());
  const std::vector<std::uint64_t>& ids = particles_->ids;
  const auto search_some = [&](std::span<const Candidate> candidates, Found& all) {
    std::array<Query, together> queries;
    std::array<FinderResult, together> results;
    const std::size_t count = candidates.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Candidate& c = candidates[k];
      const Vec3 shift = step_at_hand_.box.displacement(c.image, step_at_hand_.offset);
      queries[k] = {c.low, c.high, shift.x(), shift.y(), step_at_hand_.begin};
    }
    finder().find_all(std::span(queries).first(count), std::span(results).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      const Candidate& c = candidates[k];
      const FinderResult& result = results[k];
      if (watch_)
        watch_->searched(queries[k], result);
      if (result.contact())
        all.events.push_back({result.time, ids[c.low], ids[c.high], c.image, c.low, c.high, 0, 0});
      all.gave_up += result.exit == FinderExit::gave_up;
      all.broken |= result.exit == FinderExit::not_a_number;
    }
  };
  const auto search_block = [&](std::size_t b) {
    const std::span<const Candidate> block = candidates_[b];
    for (std::size_t k = 0; k < block.size() && !interrupted(); k += together)
      search_some(block.subspan(k, std::min(together, block.size() - k)), found[b]);
  };
  if (watch_)
    for (std::size_t b = 0; b < found.size(); ++b)
      search_block(b);
  else
    for_each_block(search_block);
  throw_if_interrupted();
  std::vector<Event> all;
  for (const Found& f : found) {
    all.insert(all.end(), f.events.begin(), f.events.end());
    gave_up_ += f.gave_up;
    if (f.broken)
      throw InvariantError("a collision search met numbers that are not finite");
  }
  return all;
}

DriftCosts DriftEngine::costs() const {
  DriftCosts costs = costs_;
  costs.lists_made = lists_.counts().rebuilds;
  costs.pairs_tested = lists_.counts().tested;
  costs.listed = lists_.counts().listed;
  costs.listed_anew = lists_.counts().renewed;
  costs.deferred = optimistic_.deferred;
  costs.in_sequence = optimistic_.last_deferred;
  costs.rolled_back = optimistic_.rolled_back;
  return costs;
}

std::size_t DriftEngine::bytes() const {
  std::size_t total = particles_->bodies.capacity() * sizeof(Body) + particles_->ids.capacity() * sizeof(std::uint64_t);
  total += lists_.bytes() + optimistic_.bytes() + events_.bytes() + so_far_.bytes();
  total += touched_.capacity() * sizeof(std::uint32_t);
  total += particles_->size() * finder().bytes_per_particle();
  for (const std::vector<Candidate>& block : candidates_)
    total += block.capacity() * sizeof(Candidate) + sizeof(std::vector<Candidate>);
  return total;
}

} // namespace keeler
