#include "drift_engine.hpp"

#include <keeler/collision/finders.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace keeler {

DriftEngine::DriftEngine(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                         double step)
    : settings_(settings), frequencies_(frequencies), orbital_frequency_(orbital_frequency), step_(step),
      finder_(make_finder(settings.finder)), finder_step_(frequencies, -0.5 * step, 0.5 * step, 0.0),
      neighbours_(frequencies, step), grid_(frequencies, step) {
  if (!finder_)
    throw UsageError(fmt::format("unknown collision finder '{}'", settings.finder));
}

// The orbits in the store itself: one loop has them all.
struct DriftEngine::InPlace {
  DriftEngine& drift;
  CollisionTally& tally;

  const Body& body(std::size_t i) const { return drift.particles_->bodies[i]; }
  std::uint32_t stamp(std::size_t i) const { return drift.so_far_.stamp(i); }
  double last_change(std::size_t i) const { return drift.so_far_.last_change(i); }
  bool is_due(const Event& event) const { return drift.so_far_.holds(event); }
  bool keeps(const Event&) const { return true; }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (stamp(i) == 0)
      drift.touched_.push_back(i);
    drift.so_far_.change(i, time);
    drift.particles_->bodies[i].elements = elements;
    if (drift.through_grid_)
      drift.grid_.changed(i);
    else
      drift.neighbours_.changed(drift.neighbours_.whole(), 0, i);
    drift.crowds_.changed(i);
    drift.finder_->changed(i);
    if (drift.watch)
      drift.watch->changed(i);
  }

  // Who watches sees partners in the order of their ids and images.
  template<class Visit> double visit_partners(std::uint32_t i, double from, const Visit& visit) {
    if (!drift.watch)
      return visit_unordered(i, from, visit);
    std::vector<Candidate> partners;
    visit_unordered(i, from, [&](std::size_t j, const Image& image) {
      partners.push_back({i, static_cast<std::uint32_t>(j), image});
    });
    drift.put_in_order(partners);
    for (const Candidate& c : partners)
      visit(c.high, c.image);
    return HUGE_VAL;
  }

  template<class Visit> double visit_unordered(std::uint32_t i, double from, const Visit& visit) {
    if (drift.through_grid_)
      drift.grid_.visit_partners(i, from, visit);
    else if (const Crowd* crowd = crowd_of(i))
      return visit_crowd(*crowd, from, visit);
    else if (MirrorPart& whole = drift.neighbours_.whole(); drift.neighbours_.one_image(whole, i))
      gather_crowd(i, drift.neighbours_.visit_partners(whole, 0, i, from, buffer, visit));
    else
      drift.neighbours_.visit_everywhere(i, from, visit);
    return HUGE_VAL;
  }

  // Whom the centre will have met before it is likely to be hit again: searches for contacts after that would be in
  // vain. The crowd serves until then, as it depends on the centre's path alone; unless somebody became so fast that
  // nearest images will not do, who ends the window. A finder that errs might see a contact before that can be, so it
  // is asked about all.
  template<class Visit> double visit_crowd(const Crowd& crowd, double from, const Visit& visit) {
    constexpr double hits_ahead = 2.0, least_share = 1.0 / 256.0; // of the step
    const std::uint32_t i = crowd.centre();
    const double begin = drift.step_at_hand_.begin, end = -begin;
    const double ahead = std::max(hits_ahead * (from - begin) / stamp(i), least_share * drift.step_);
    const auto start = [&](std::size_t j) { return std::max(last_change(i), last_change(j)); }; // of a search
    if (drift.watch || !drift.finder_->exact() || from + ahead >= end) {
      crowd.visit(from, end, buffer, [&](std::uint32_t j) {
        drift.neighbours_.visit_nearest(body(i), body(j), start(j), [&](const Image& image) { visit(j, image); });
      });
      return HUGE_VAL;
    }
    const Rotation now(drift.frequencies_, from);
    crowd.visit(from, from + ahead, buffer, [&](std::uint32_t j) {
      drift.neighbours_.visit_nearest_soon(body(i), body(j), start(j), now, ahead,
                                           [&](const Image& image) { visit(j, image); });
    });
    return from + ahead;
  }

  // At the second hit of a step, and now and then when one was lost, for a particle with many around it.
  void gather_crowd(std::uint32_t i, std::size_t near) {
    constexpr std::uint32_t apart = 8; // hits
    if (near < Neighbours::fewest_in_crowd || stamp(i) % apart != 2)
      return;
    Crowd* crowd = drift.crowds_.add(drift.step_at_hand_, i);
    if (crowd && !drift.neighbours_.gather(i, last_change(i), buffer, *crowd))
      drift.crowds_.drop(crowd);
  }

  const Crowd* crowd_of(std::uint32_t i) {
    const Crowd* crowd = drift.crowds_.of(i);
    if (!crowd || drift.neighbours_.holds(*crowd))
      return crowd;
    drift.crowds_.drop(crowd);
    return nullptr;
  }

  void prefetch(std::size_t i, int stage) const {
    if (stage == 0)
      drift.so_far_.prefetch(i);
    if (!drift.through_grid_)
      drift.neighbours_.prefetch(i, stage);
  }

  FinderResult find(const Query& query) const {
    const FinderResult result = drift.finder_->find(query);
    if (drift.watch)
      drift.watch->searched(query, result);
    drift.gave_up_ += result.exit == FinderExit::gave_up;
    return result;
  }

  void happened(const Event& event, const Contact& contact) {
    drift.count(contact, tally);
    if (drift.watch)
      drift.watch->collided({event.time, event.low_id, event.high_id, event.image, contact.normal_speed, contact.fast});
  }

  std::vector<std::uint32_t> buffer;
};

void DriftEngine::collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally) {
  particles_ = &particles;
  step_at_hand_ = {&particles, &settings_, frequencies_, orbital_frequency_, box, offset, -0.5 * step_};
  gave_up_ = 0;
  prepare();
  reject();
  std::vector<Event> first = solve();
  const Stopwatch stopwatch(costs_.events);
  const std::uint64_t contacts_before = costs_.contacts;
  const bool parted = in_strips(first);
  if (!parted) {
    events_.assign(first);
    neighbours_.set_lookers(1);
    InPlace orbits{*this, tally, {}};
    ContactLoop loop(step_at_hand_, orbits, events_);
    loop.run();
    costs_.widest_list = std::max(costs_.widest_list, loop.most_partners());
  }
  const std::uint64_t contacts = parted ? strips_.contacts() : costs_.contacts - contacts_before;
  const auto tally_strips = [&] {
    if (parted)
      strips_.visit_contacts([&](const Contact& contact) { count(contact, tally); });
  };
  if (!through_grid_)
    neighbours_.settle(touched_, contacts, tally_strips);
  tally.gave_up += gave_up_;
  if (particles.size())
    costs_.bytes_per_particle = bytes() / particles.size();
  particles_ = nullptr; // the caller's, who may move it
}

void DriftEngine::count(const Contact& contact, CollisionTally& tally) {
  tally.add(contact);
  ++costs_.contacts;
  costs_.recontacts += contact.again;
}

// On several threads, when the result cannot tell and it is likely to be faster: with enough contacts for each strip,
// few enough of all particles hit for conflicts to be rare, and room between the strips' edges.
bool DriftEngine::in_strips(const std::vector<Event>& first) {
  constexpr std::size_t fewest_contacts = 50, fewest_columns = 16; // of a strip
  constexpr std::size_t largest_share = 16;                        // one in so many particles
  if (through_grid_ || watch || !finder_->exact() || neighbours_.mirror().has_guests())
    return false;
  auto strips = std::min(Strips::most_strips, static_cast<std::size_t>(threads()));
  if (!always_in_strips) {
    if (first.size() * largest_share > particles_->size())
      return false;
    strips = std::min({strips, first.size() / fewest_contacts, neighbours_.mirror().columns() / fewest_columns});
    if (strips < 2)
      return false;
  }
  if (!strips_.carry_out(step_at_hand_, *particles_, so_far_, *finder_, neighbours_, first, strips))
    return false;
  costs_.widest_list = std::max(costs_.widest_list, strips_.most_partners());
  strips_.list_touched(touched_);
  return true;
}

void DriftEngine::prepare() {
  const Stopwatch stopwatch(costs_.build);
  ++costs_.steps;
  so_far_.begin_step(particles_->size(), -0.5 * step_);
  touched_.clear();
  crowds_.begin_step();
  const ShearingBox& box = step_at_hand_.box;
  if (every_candidate)
    neighbours_.forget();
  through_grid_ = every_candidate || !neighbours_.begin(*particles_, box, step_at_hand_.offset);
  if (through_grid_)
    grid_.begin(*particles_, box, step_at_hand_.offset, every_candidate);
  finder_step_ = DriftStep(frequencies_, -0.5 * step_, 0.5 * step_, box.size_x + box.size_y);
  finder_step_.bodies = particles_->bodies;
  finder_step_.tested = !every_candidate;
  finder_->begin(finder_step_);
  if (watch)
    watch->begins(finder_step_);
}

// First those blocks that follow each other in space: each thread meets the same part of the box again.
template<class Body> void DriftEngine::for_each_block(const Body& body) const {
  const std::size_t first = through_grid_ ? candidates_.size() : neighbours_.first_blocks();
  parallel_for(first, body, 1);
  parallel_for(
      candidates_.size() - first, [&](std::size_t b) { body(first + b); }, 1);
}

// The pairs that the finder has to be asked about, block by block.
void DriftEngine::reject() {
  const Stopwatch stopwatch(costs_.reject);
  candidates_.resize(through_grid_ ? grid_.blocks() : neighbours_.blocks());
  for_each_block([&](std::size_t b) {
    candidates_[b].clear();
    const auto keep = [&](std::size_t low, std::size_t high, const Image& image) {
      candidates_[b].push_back({static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high), image});
    };
    if (through_grid_)
      grid_.visit_block(b, keep);
    else
      neighbours_.visit_block(b, keep);
  });
  for (const std::vector<Candidate>& block : candidates_)
    costs_.survivors += block.size();
  if (watch && !every_candidate) { // no window and no number of threads shows in what is watched
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
  const Stopwatch stopwatch(costs_.solve);
  struct Found {
    std::vector<Event> events;
    std::uint64_t gave_up = 0;
    bool broken = false;
  };
  std::vector<Found> found(candidates_.size());
  const std::vector<std::uint64_t>& ids = particles_->ids;
  const auto search_block = [&](std::size_t b) {
    for (const Candidate& c : candidates_[b]) {
      if (interrupted())
        return;
      const Vec3 shift = step_at_hand_.box.displacement(c.image, step_at_hand_.offset);
      const Query query{c.low, c.high, shift.x(), shift.y(), step_at_hand_.begin};
      const FinderResult result = finder_->find(query);
      if (watch)
        watch->searched(query, result);
      if (result.contact())
        found[b].events.push_back({result.time, ids[c.low], ids[c.high], c.image, c.low, c.high, 0, 0});
      found[b].gave_up += result.exit == FinderExit::gave_up;
      found[b].broken |= result.exit == FinderExit::not_a_number;
    }
  };
  if (watch)
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
  costs.windows = neighbours_.windows;
  costs.pairs_tested = neighbours_.tested;
  costs.listed = neighbours_.listed;
  costs.conflicts = strips_.conflicts;
  costs.repairs = strips_.repairs;
  return costs;
}

std::size_t DriftEngine::bytes() const {
  std::size_t total = particles_->bodies.capacity() * sizeof(Body) + particles_->ids.capacity() * sizeof(std::uint64_t);
  total += neighbours_.bytes() + strips_.bytes() + events_.bytes() + so_far_.bytes() + crowds_.bytes();
  total += touched_.capacity() * sizeof(std::uint32_t);
  total += particles_->size() * finder_->bytes_per_particle();
  for (const std::vector<Candidate>& block : candidates_)
    total += block.capacity() * sizeof(Candidate) + sizeof(std::vector<Candidate>);
  return total;
}

} // namespace keeler
