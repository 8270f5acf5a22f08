#include <keeler/collision/contact_groups.hpp>

#include <algorithm>
#include <numeric>

namespace keeler {
namespace {

// Which member of a group a particle is; −1 for none. Open addressing.
class PlaceTable {
public:
  void clear() {
    used_ = 0;
    std::fill(entries_.begin(), entries_.end(), Entry{});
  }

  std::int32_t find(std::uint32_t place) const {
    for (std::size_t k = first(place);; k = (k + 1) & (entries_.size() - 1)) {
      if (entries_[k].member < 0 || entries_[k].place == place)
        return entries_[k].member;
    }
  }

  void add(std::uint32_t place, std::int32_t member) {
    if (2 * ++used_ > entries_.size()) {
      std::vector<Entry> old(2 * entries_.size());
      old.swap(entries_);
      for (const Entry& e : old)
        if (e.member >= 0)
          put(e);
    }
    put({place, member});
  }

private:
  struct Entry {
    std::uint32_t place = 0;
    std::int32_t member = -1;
  };
  std::size_t first(std::uint32_t place) const { return (place * 2654435761u >> 7) & (entries_.size() - 1); }
  void put(const Entry& entry) {
    std::size_t k = first(entry.place);
    while (entries_[k].member >= 0)
      k = (k + 1) & (entries_.size() - 1);
    entries_[k] = entry;
  }

  std::vector<Entry> entries_ = std::vector<Entry>(16);
  std::size_t used_ = 0;
};

constexpr std::int32_t nobody = -1;

} // namespace

struct ContactGroups::Scratch {
  PlaceTable table;
  EventQueue events;
  std::vector<std::uint32_t> buffer;
};

// A group's own view: the store as it was at the start of the step, under the new orbits of its members.
struct ContactGroups::Orbits {
  const ContactGroups& all;
  Group& group;
  Scratch& scratch;

  const Member* member(std::size_t i) const {
    const std::int32_t m = scratch.table.find(static_cast<std::uint32_t>(i));
    return m < 0 ? nullptr : &group.members[m];
  }
  const Body& body(std::size_t i) const {
    const Member* m = member(i);
    return m ? m->body : all.step_->particles->bodies[i];
  }
  std::uint32_t stamp(std::size_t i) const {
    const Member* m = member(i);
    return m ? m->stamp : 0;
  }
  double last_change(std::size_t i) const {
    const Member* m = member(i);
    return m ? m->last_change : all.step_->begin;
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    std::int32_t m = scratch.table.find(i);
    if (m == nobody) {
      m = static_cast<std::int32_t>(group.members.size());
      scratch.table.add(i, m);
      group.members.push_back({i, 0, all.step_->particles->bodies[i], 0.0, -1});
    }
    Member& member = group.members[m];
    group.pieces.push_back({time, elements, member.piece});
    member.piece = static_cast<std::int32_t>(group.pieces.size()) - 1;
    const Body& at_start = all.step_->particles->bodies[i];
    member.off = std::max(member.off, all.neighbours_->departure(elements - at_start.elements));
    member.body.elements = elements;
    member.last_change = time;
    ++member.stamp;
    group.farthest = std::max(group.farthest, member.off);
    group.too_large |= group.members.size() > most_members || group.contacts.size() > most_contacts;
  }

  template<class Visit> void visit_partners(std::size_t i, const Visit& visit) {
    if (group.too_large) {
      scratch.events.clear();
      return;
    }
    const Body& own = body(i);
    const double start = last_change(i);
    const auto others = [&](std::size_t j, const Image& image) {
      if (scratch.table.find(static_cast<std::uint32_t>(j)) == nobody)
        visit(j, image);
    };
    group.too_large |= !all.neighbours_->visit_partners(i, own, start, scratch.buffer, others);
    for (const Member& other : group.members)
      if (other.place != i)
        all.neighbours_->visit_nearest(own, other.body, start, [&](const Image& image) { visit(other.place, image); });
  }

  FinderResult find(const Query& query) const {
    return all.finder_->find_between(query, body(query.low), body(query.high));
  }

  void prefetch(std::size_t, int) const {} // a group's contacts are too few

  void happened(const Contact& contact) { group.contacts.push_back(contact); }
};

bool ContactGroups::carry_out(const StepAtHand& step, const Finder& finder, const Neighbours& neighbours,
                              const std::vector<Event>& first) {
  step_ = &step;
  finder_ = &finder;
  neighbours_ = &neighbours;
  if (!form(first))
    return false;
  for (int round = 0;; ++round) {
    if (round == most_rounds || !run_fresh())
      return false;
    Pairs conflicting;
    claim(conflicting);
    double farthest = 0.0;
    for (std::size_t g = 0; g < used_; ++g)
      farthest = std::max(farthest, groups_[g].farthest);
    std::vector<Pairs> seen((used_ + 15) / 16);
    parallel_for(
        seen.size(),
        [&](std::size_t b) {
          for (std::size_t g = 16 * b; g < std::min(used_, 16 * b + 16); ++g)
            if (groups_[g].fresh)
              look_around(static_cast<std::uint32_t>(g), farthest, round == 0, seen[b]);
        },
        1);
    for (const Pairs& pairs : seen)
      conflicting.insert(conflicting.end(), pairs.begin(), pairs.end());
    if (conflicting.empty())
      return true;
    conflicts += conflicting.size();
    merge(conflicting);
  }
}

// First contacts that share a particle belong together. Returns false when too many do.
bool ContactGroups::form(const std::vector<Event>& first) {
  if (claims_.size() == neighbours_->size())
    for (const std::uint32_t slot : claimed_)
      claims_[slot] = 0;
  else
    claims_.assign(neighbours_->size(), 0);
  claimed_.clear();
  merged_in_.resize(first.size());
  std::iota(merged_in_.begin(), merged_in_.end(), 0u);
  for (std::uint32_t e = 0; e < first.size(); ++e)
    for (const std::uint32_t place : {first[e].low, first[e].high}) {
      const std::uint32_t slot = neighbours_->slot(place);
      if (claims_[slot] == 0) {
        claims_[slot] = e + 1;
        claimed_.push_back(slot);
      } else {
        const std::uint32_t a = root(claims_[slot] - 1), b = root(e);
        merged_in_[std::max(a, b)] = std::min(a, b);
      }
    }
  std::vector<std::uint32_t> group_of(first.size());
  used_ = 0;
  for (std::uint32_t e = 0; e < first.size(); ++e) {
    const std::uint32_t r = root(e);
    if (r == e) {
      group_of[e] = static_cast<std::uint32_t>(used_++);
      if (groups_.size() < used_)
        groups_.emplace_back();
      groups_[used_ - 1].first.clear();
      groups_[used_ - 1].fresh = true;
    }
    groups_[group_of[r]].first.push_back(first[e]);
    if (groups_[group_of[r]].first.size() > most_members)
      return false;
  }
  for (const std::uint32_t slot : claimed_)
    claims_[slot] = group_of[root(claims_[slot] - 1)] + 1;
  merged_in_.resize(used_);
  std::iota(merged_in_.begin(), merged_in_.end(), 0u);
  return true;
}

std::uint32_t ContactGroups::root(std::uint32_t group) {
  while (merged_in_[group] != group)
    group = merged_in_[group] = merged_in_[merged_in_[group]];
  return group;
}

void ContactGroups::run(Group& group) const {
  static thread_local Scratch scratch;
  group.members.clear();
  group.pieces.clear();
  group.contacts.clear();
  group.farthest = 0.0;
  group.too_large = false;
  group.failed = false;
  scratch.table.clear();
  scratch.events.assign(group.first);
  Orbits orbits{*this, group, scratch};
  ContactLoop loop(*step_, orbits, scratch.events);
  try {
    loop.run();
  } catch (const InvariantError&) {
    group.failed = true;
  }
  group.most_partners = loop.most_partners();
}

void ContactGroups::prefetch(const Group& group, int stage) const {
  for (const Event& event : group.first)
    for (const std::uint32_t place : {event.low, event.high}) {
      if (stage == 0)
        __builtin_prefetch(&step_->particles->bodies[place]);
      neighbours_->prefetch(place, stage);
    }
}

// Returns false when a group has become too large.
bool ContactGroups::run_fresh() {
  constexpr std::size_t apart = 5;
  parallel_for(
      used_,
      [&](std::size_t g) {
        for (int stage = 0; stage < 3; ++stage)
          if (const std::size_t soon = g + (3 - stage) * apart; soon < used_)
            prefetch(groups_[soon], stage);
        if (groups_[g].fresh)
          run(groups_[g]);
      },
      32);
  for (std::size_t g = 0; g < used_; ++g)
    if (groups_[g].fresh && (groups_[g].too_large || groups_[g].failed))
      return false;
  return true;
}

// Every particle that a group has hit is its own, or there is a conflict.
void ContactGroups::claim(Pairs& conflicting) {
  for (std::uint32_t g = 0; g < used_; ++g) {
    if (!groups_[g].fresh)
      continue;
    for (const Member& member : groups_[g].members) {
      std::uint32_t& claim = claims_[neighbours_->slot(member.place)];
      if (claim == 0) {
        claim = g + 1;
        claimed_.push_back(neighbours_->slot(member.place));
      } else if (root(claim - 1) != g) {
        conflicting.emplace_back(root(claim - 1), g);
      }
    }
  }
}

// Conflicts of a group's members with others that were hit nearby. When all groups look around, of two particles the
// one that got farther off its path finds the other.
void ContactGroups::look_around(std::uint32_t g, double farthest, bool all_fresh, Pairs& conflicting) const {
  const Group& group = groups_[g];
  for (const Member& i : group.members)
    neighbours_->visit_slots_near(i.place, i.off + (all_fresh ? i.off : farthest),
                                  [&](std::uint32_t begin, std::uint32_t end) {
                                    for (std::uint32_t slot = begin; slot < end; ++slot) {
                                      if (claims_[slot] == 0 || claims_[slot] == g + 1)
                                        continue;
                                      std::uint32_t other = claims_[slot] - 1;
                                      while (merged_in_[other] != other)
                                        other = merged_in_[other];
                                      if (other == g)
                                        continue;
                                      for (const Member& k : groups_[other].members)
                                        if (neighbours_->slot(k.place) == slot && meet(group, i, groups_[other], k))
                                          conflicting.emplace_back(g, other);
                                    }
                                  });
}

// Whether any two new pieces of their paths bring two particles into contact.
bool ContactGroups::meet(const Group& a, const Member& i, const Group& b, const Member& k) const {
  const bool ordered = step_->particles->ids[i.place] < step_->particles->ids[k.place];
  Body first = i.body, second = k.body;
  double end = HUGE_VAL;
  for (std::int32_t pa = i.piece, pb = k.piece; pa >= 0 && pb >= 0;) { // from the last pieces back
    const Piece &one = a.pieces[pa], &other = b.pieces[pb];
    if (one.begin == other.begin)
      return true; // a tie: let the group's order settle it
    first.elements = one.elements, second.elements = other.elements;
    const double begin = std::max(one.begin, other.begin);
    bool contact = false;
    neighbours_->visit_nearest(first, second, begin, [&](const Image& image) {
      const Vec3 shift = step_->box.displacement(ordered ? image : -image, step_->offset);
      const Query query{ordered ? i.place : k.place, ordered ? k.place : i.place, shift.x(), shift.y(), begin};
      const FinderResult result = finder_->find_between(query, ordered ? first : second, ordered ? second : first);
      contact = (result.contact() && result.time <= end) || result.exit == FinderExit::not_a_number;
    });
    if (contact)
      return true;
    end = begin;
    if (one.begin > other.begin)
      pa = one.earlier;
    else
      pb = other.earlier;
  }
  return false;
}

void ContactGroups::merge(const Pairs& conflicting) {
  for (std::size_t g = 0; g < used_; ++g)
    groups_[g].fresh = false;
  for (const auto& [one, other] : conflicting) {
    const std::uint32_t a = root(one), b = root(other);
    if (a == b)
      continue;
    Group &into = groups_[std::min(a, b)], &from = groups_[std::max(a, b)];
    merged_in_[std::max(a, b)] = std::min(a, b);
    into.first.insert(into.first.end(), from.first.begin(), from.first.end());
    into.fresh = true;
    from.first.clear();
    from.members.clear();
    from.contacts.clear();
    from.farthest = 0.0;
    from.fresh = false;
    ++repairs;
  }
}

void ContactGroups::write(std::vector<Body>& bodies) const {
  parallel_for(
      used_,
      [&](std::size_t g) {
        for (const Member& member : groups_[g].members)
          bodies[member.place].elements = member.body.elements;
      },
      64);
}

// A contact made at its maker's own time may have a smaller key; it comes right after its maker all the same.
std::vector<const Contact*> ContactGroups::contacts() const {
  struct Ranked {
    double time;
    const Event* rank;
    const Contact* contact;
  };
  std::vector<Ranked> ranked;
  for (std::size_t g = 0; g < used_; ++g) {
    const Event* largest = nullptr;
    for (const Contact& contact : groups_[g].contacts) {
      if (!largest || *largest < contact.event)
        largest = &contact.event;
      ranked.push_back({largest->time, largest, &contact});
    }
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    if (a.time != b.time)
      return a.time < b.time;
    return a.rank == b.rank ? a.contact < b.contact : *a.rank < *b.rank; // contacts of a group stand in their order
  });
  std::vector<const Contact*> all;
  for (const Ranked& r : ranked)
    all.push_back(r.contact);
  return all;
}

std::uint64_t ContactGroups::most_partners() const {
  std::uint64_t most = 0;
  for (std::size_t g = 0; g < used_; ++g)
    most = std::max(most, groups_[g].most_partners);
  return most;
}

std::size_t ContactGroups::Group::bytes() const {
  return sizeof *this + first.capacity() * sizeof(Event) + members.capacity() * sizeof(Member) +
         pieces.capacity() * sizeof(Piece) + contacts.capacity() * sizeof(Contact);
}

void ContactGroups::trim() {
  constexpr std::size_t usual = 1500; // bytes: two or three contacts
  for (Group& group : groups_)
    if (group.bytes() > usual)
      group = Group();
}

std::size_t ContactGroups::bytes() const {
  std::size_t total = (claims_.capacity() + claimed_.capacity() + merged_in_.capacity()) * sizeof(std::uint32_t);
  for (const Group& group : groups_)
    total += group.bytes();
  return total;
}

} // namespace keeler
