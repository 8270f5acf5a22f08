// A step that ranks share. Its answer is the one history of all particles that the order of events defines; each rank
// makes the part of its own ones.
//
// First each rank carries out all contacts of its own particles and of its copies, as if there were nobody else. Copies
// near the outer border lack partners, so their paths may be wrong, and then those of others that touch these; but
// contacts are few in a step, and the farther copies are there for this: nearly always the paths of own particles and
// of near copies are right. Whether they are is told by the owners, who say how the paths of all copies went.
//
// Where a near copy went another way than its owner says, all is undone, and done again with each copy on the path that
// its owner has told, until no owner has anything new to tell. (So waveform relaxation solves differential equations in
// parts that overlap: Lelarasmee, Ruehli & Sangiovanni-Vincentelli 1982; Gander & Stuart 1998.) A copy leaves that path
// where somebody touches it otherwise than its owner knows.
//
// Why it ends, and ends right: let all paths that owners have told be right before some time, and let the next contact
// of the true history come then. Its particles know each other, as own ones or as near copies, and both are on their
// right paths. So every rank that owns one of them finds that contact, with the same numbers, and tells it. Every round
// makes at least one more contact right. When nothing new is told and no near copy differs, each rank has found every
// contact of its own particles on paths that their owners confirm: that is the true history. (Within the margins, which
// are looked at last: the first contact that leads beyond them is right too, so that is seen.)
#include "in_place.hpp"

#include <keeler/core/stopwatch.hpp>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <exception>
#include <tuple>
#include <utility>

namespace keeler {

// What an owner says of a path: a copy's number among those it has lent to that rank, when it changed, and to what.
struct DriftEngine::Told {
  std::uint64_t number;
  double time;
  Elements elements;
  Vec3 spin;
};

namespace {

template<class Row> std::vector<Row> rows_of(const std::vector<std::byte>& bytes) {
  std::vector<Row> rows(bytes.size() / sizeof(Row));
  if (!rows.empty())
    std::memcpy(static_cast<void*>(rows.data()), bytes.data(), bytes.size());
  return rows;
}

template<class Row> std::vector<std::byte> packed(const std::vector<Row>& rows) {
  const auto bytes = std::as_bytes(std::span(rows));
  return {bytes.begin(), bytes.end()};
}

bool same(const Elements& a, const Elements& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

constexpr std::uint64_t after_all_ids = ~std::uint64_t{0}; // contacts at the same instant come first

} // namespace

// Copies are on the paths that their owners have told; the others as in place.
struct DriftEngine::FollowsOwners : DriftEngine::InPlace {
  struct Line {
    std::size_t next = 0, end = 0; // what is still to come of its path
    bool is_told = true;           // until it touches somebody of whom its owner does not know
  };
  std::size_t own;
  std::vector<Told> told{};
  std::vector<Line> lines{}; // each copy

  bool is_told(std::uint32_t i) const { return i >= own && lines[i - own].is_told; }

  bool is_due(const Event& event) {
    if (event.low_id == after_all_ids)
      return takes_turn(event);
    return InPlace::is_due(event) && !(is_told(event.low) && is_told(event.high));
  }

  // A turn that was told, unless the contact that made it has been carried out here.
  bool takes_turn(const Event& event) {
    Line& line = lines[event.low - own];
    if (!line.is_told || line.next != event.low_stamp)
      return false;
    const Told& turn = told[line.next++];
    InPlace::change(event.low, turn.elements, turn.time);
    if (drift.particles_->rough)
      set_spin(event.low, turn.spin);
    return true;
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (is_told(i)) {
      Line& line = lines[i - own];
      const bool known =
          line.next < line.end && told[line.next].time == time && same(told[line.next].elements, elements);
      if (known)
        ++line.next;
      else
        line.is_told = false;
    }
    InPlace::change(i, elements, time);
  }

  bool may_look_again(std::uint32_t) const { return false; }
};

// The step at hand of all ranks.
struct DriftEngine::Sharing {
  DriftEngine& drift;
  const GhostLayer& borders;
  const Communicator& ranks;
  std::vector<Event> first{};
  Parcels told{};               // by own particles, to each rank
  std::vector<Told> heard{};    // of the copies, by place; the number is that of the copy here
  CollisionTally tally{};       // of the last round
  std::exception_ptr failure{}; // in it: of a history that may be wrong

  template<class Work> void carry_out(const Work& work) {
    tally = {};
    failure = nullptr;
    try {
      work();
    } catch (const InvariantError&) {
      failure = std::current_exception();
    }
    drift.complete_changes();
  }

  // Returns whether anything is new to one of the ranks.
  bool tell() {
    Parcels news(ranks.size());
    for (std::size_t rank = 0; rank < ranks.size(); ++rank)
      news[rank] = packed(to_tell(borders.sent[rank]));
    const bool is_new = ranks.any(news != told);
    told = news;
    const Parcels from = ranks.exchange(std::move(news));
    heard.clear();
    for (std::size_t rank = 0; rank < ranks.size(); ++rank)
      for (Told turn : rows_of<Told>(from[rank])) {
        turn.number += borders.first[rank] - borders.own;
        heard.push_back(turn);
      }
    return is_new;
  }

  std::vector<Told> to_tell(const std::vector<std::uint32_t>& lent) const {
    std::vector<Told> rows;
    auto change = drift.changes_.begin();
    assert(std::is_sorted(lent.begin(), lent.end()));
    for (std::uint64_t number = 0; number < lent.size(); ++number) {
      change = std::lower_bound(change, drift.changes_.end(), lent[number],
                                [](const PathChange& c, std::uint32_t place) { return c.place < place; });
      for (; change != drift.changes_.end() && change->place == lent[number]; ++change)
        rows.push_back({number, change->time, change->after, change->spin_after});
    }
    return rows;
  }

  // Whether a near copy went here as its owner says, each.
  bool near_copies_agree() const {
    const auto is_far = [&](const Told& turn) { return !borders.near[turn.number]; };
    std::vector<Told> theirs = heard, here;
    std::erase_if(theirs, is_far);
    for (const PathChange& change : drift.changes_)
      if (change.place >= borders.own)
        here.push_back({change.place - borders.own, change.time, change.after, change.spin_after});
    std::erase_if(here, is_far);
    return packed(theirs) == packed(here);
  }

  // The whole step, with the copies on the paths that were heard.
  void follow_owners() {
    FollowsOwners orbits{{drift, tally}, borders.own};
    orbits.told = heard;
    orbits.lines.resize(borders.near.size());
    std::vector<Event> events = first;
    for (std::size_t k = 0; k < heard.size(); ++k) {
      FollowsOwners::Line& line = orbits.lines[heard[k].number];
      if (line.end == 0)
        line.next = k;
      line.end = k + 1;
      const auto place = static_cast<std::uint32_t>(borders.own + heard[k].number);
      events.push_back({heard[k].time, after_all_ids, k, {}, place, place, static_cast<std::uint32_t>(k), 0});
    }
    drift.events_.assign(events);
    ContactLoop loop(drift.step_at_hand_, orbits, drift.events_);
    loop.run();
  }

  // Whether all own particles of all ranks have stayed where their borders are good.
  bool within_margins() const { return !ranks.any(drift.strayed_); }
};

void DriftEngine::forget_changes() {
  beginnings_.clear();
  changes_.clear();
  strayed_ = false;
}

// Before it happens.
void DriftEngine::note_change(std::uint32_t place, double time, const Elements& after) {
  const Elements& before = particles_->bodies[place].elements;
  const Vec3 spin = particles_->rough ? particles_->spins[place] : Vec3::Zero();
  if (so_far_.stamp(place) == 0)
    beginnings_.push_back({place, before, spin});
  if (borders_->on_two_ranks(place))
    changes_.push_back({place, time, before, {}, spin, Vec3::Zero()});
  note_path(place, after);
}

void DriftEngine::note_path(std::uint32_t place, const Elements& path) {
  strayed_ = strayed_ || (place < borders_->own && !borders_->within_margin(place, path, step_));
}

// The same of a step that was carried out in domains.
void DriftEngine::note_changes_of_domains() {
  std::vector<std::uint32_t> places = touched_;
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const std::uint32_t place : places) {
    const bool has_copies = borders_->on_two_ranks(place);
    const auto changes_before = static_cast<std::ptrdiff_t>(changes_.size());
    Beginning first{place, particles_->bodies[place].elements, Vec3::Zero()};
    optimistic_.visit_changes(place, [&](double time, const Elements& before, const Vec3& spin) { // from the last one
      note_path(place, first.elements);
      if (has_copies)
        changes_.push_back({place, time, before, {}, spin, Vec3::Zero()});
      first.elements = before;
      first.spin = spin;
    });
    beginnings_.push_back(first);
    std::reverse(changes_.begin() + changes_before, changes_.end());
  }
}

// Sorts the changes of a step that has been carried out, and fills in what paths changed to.
void DriftEngine::complete_changes() {
  std::stable_sort(changes_.begin(), changes_.end(), [](const PathChange& a, const PathChange& b) {
    return a.place != b.place ? a.place < b.place : a.time < b.time;
  });
  for (std::size_t k = 0; k < changes_.size(); ++k) {
    PathChange& change = changes_[k];
    const bool last = k + 1 == changes_.size() || changes_[k + 1].place != change.place;
    change.after = last ? particles_->bodies[change.place].elements : changes_[k + 1].before;
    if (particles_->rough)
      change.spin_after = last ? particles_->spins[change.place] : changes_[k + 1].spin_before;
  }
}

// Everything as at the start of the step.
void DriftEngine::undo_changes() {
  CollisionTally none;
  InPlace orbits{*this, none};
  so_far_.begin_step(particles_->size(), step_at_hand_.begin);
  for (const auto& [place, elements, spin] : beginnings_) {
    particles_->bodies[place].elements = elements;
    if (particles_->rough)
      particles_->spins[place] = spin;
    if (through_grid_)
      grid_.changed(place);
    else if (!lists_.reaches_far() && !lists_.changed(place, step_at_hand_.begin))
      orbits.rebuild_list(place);
    finder().changed(place);
  }
  forget_changes();
  slow_pairs_.clear();
  records_.clear();
  sums_ = {};
  gave_up_ = 0;
}

bool DriftEngine::collide_distributed(Particles& particles, const GhostLayer& borders, const Communicator& ranks,
                                      const ShearingBox& box, double offset, CollisionTally& tally) {
  assert(finder().exact() && !(observer_ && observer_->looks_on()) && !audit_);
  counted_ = borders.own;
  borders_ = &borders;
  forget_changes();
  Sharing sharing{*this, borders, ranks};
  ranks.together([&] {
    begin_step(particles, box, offset, false);
    sharing.first = solve();
  });
  sharing.carry_out([&] { carry_out(sharing.first, sharing.tally); });
  sharing.tell();
  if (ranks.any(!sharing.near_copies_agree() || sharing.failure))
    do_again(sharing);
  // of two contacts at the very same instant the rounds may not find which comes first: then all need copies of all
  const bool done = !ranks.any(!sharing.near_copies_agree()) && sharing.within_margins();
  if (done)
    end_distributed(sharing, tally);
  else
    undo_changes();
  end_step();
  return done;
}

void DriftEngine::do_again(Sharing& sharing) {
  const Stopwatch stopwatch(costs_.events);
  ++costs_.repeated_steps;
  do {
    ++costs_.rounds_again;
    undo_changes();
    sharing.carry_out([&] { sharing.follow_owners(); });
  } while (sharing.tell());
}

// To the first rank, in the order of events.
void DriftEngine::gather_records(const Communicator& ranks) {
  std::vector<std::vector<CollisionRecord>> sent(ranks.size());
  sent[0] = std::exchange(records_, {});
  for (const std::vector<CollisionRecord>& some : ranks.exchange(sent))
    records_.insert(records_.end(), some.begin(), some.end());
  const auto key = [](const CollisionRecord& r) {
    return std::tuple(r.time, r.low_id, r.high_id, r.image.nx, r.image.ny);
  };
  std::sort(records_.begin(), records_.end(),
            [&](const CollisionRecord& a, const CollisionRecord& b) { return key(a) < key(b); });
}

// The step is done: what it did, on all ranks.
void DriftEngine::end_distributed(Sharing& sharing, CollisionTally& tally) {
  const Communicator& ranks = sharing.ranks;
  ranks.together([&] {
    if (sharing.failure)
      std::rethrow_exception(sharing.failure);
  });
  if (takes_records_)
    gather_records(ranks);
  ranks.merge({&sums_.energy_lost, &sums_.momentum_flux, &sums_.azimuthal_gain});
  add_sums(tally);
  std::uint64_t counts[] = {sharing.tally.fast, sharing.tally.slow, sharing.tally.unresolved};
  ranks.sum(counts);
  tally.fast += counts[0];
  tally.slow += counts[1];
  tally.unresolved += counts[2];
}

} // namespace keeler
