#include "strips.hpp"

#include <algorithm>
#include <cmath>

namespace keeler {

// The store as one strip sees and changes it.
struct Strips::Orbits {
  Strips& all;
  Strip& strip;
  std::size_t row;
  double farthest; // of what particles are off their paths after the rows before, m
  std::size_t next_barred = 0;
  std::vector<std::uint32_t> barred{}, buffer{};

  std::size_t number() const { return static_cast<std::size_t>(&strip - all.strips_.data()); }
  const Body& body(std::size_t i) const { return all.particles_->bodies[i]; }
  std::uint32_t stamp(std::size_t i) const { return all.so_far_->stamp(i); }
  double last_change(std::size_t i) const { return all.so_far_->last_change(i); }

  bool is_due(const Event& event) {
    if (strip.failed || strip.blamed != nobody)
      return false;
    for (; next_barred < strip.barred.size() && strip.barred[next_barred].time <= event.time; ++next_barred)
      if (const Barred& b = strip.barred[next_barred]; b.stamp == stamp(b.place))
        bar(b.place);
    if (!all.so_far_->holds(event))
      return false;
    const bool due = !(all.barred_[event.low] || all.barred_[event.high]);
    if (!due)
      put_off(event);
    return due;
  }

  // Of two particles that were just changed.
  bool keeps(const Event& event) {
    const Neighbours& neighbours = *all.neighbours_;
    if (!(neighbours.one_image(strip.part, event.low) && neighbours.one_image(strip.part, event.high))) {
      strip.failed = true;
      return false;
    }
    if (!(lies_inside(event.low) && lies_inside(event.high))) {
      strip.contacts.pop_back();
      all.take_back(strip);
      all.take_back(strip);
      put_off(event);
      return false;
    }
    if (row > 0) {
      search_past(event.low, event.time);
      search_past(event.high, event.time);
    }
    return true;
  }

  bool lies_inside(std::uint32_t i) const {
    Line line = all.neighbours_->mirror().line(i);
    line.size += static_cast<float>(1.001 * farthest);
    return all.neighbours_->mirror().encloses(strip.part, line);
  }

  void put_off(const Event& event) {
    strip.put_off.push_back(event);
    bar(event.low);
    bar(event.high);
  }

  void bar(std::uint32_t i) {
    all.barred_[i] = 1;
    barred.push_back(i);
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    Body& body = all.particles_->bodies[i];
    const std::uint32_t earlier = newest(i);
    const double off = all.neighbours_->departure(elements - body.elements) + (earlier ? all.change(earlier).off : 0.0);
    if (earlier && earlier / most_changes != number()) // made at this instant: time and ids can't tell their order
      strip.failed |= all.change(earlier).time >= time;
    strip.changes.push_back(
        {i, earlier, in_rows_before(earlier), all.neighbours_->mark(i), last_change(i), time, off, body.elements});
    strip.failed |= strip.changes.size() + 3 > most_changes;
    if (!earlier)
      strip.touched.push_back(i);
    all.newest_[i] = static_cast<std::uint32_t>(number() * most_changes + strip.changes.size());
    all.so_far_->change(i, time);
    body.elements = elements;
    all.neighbours_->changed(strip.part, number(), i);
  }

  std::uint32_t newest(std::size_t i) const { return stamp(i) > 0 ? all.newest_[i] : 0; }
  std::uint32_t in_rows_before(std::uint32_t number) const {
    return number && number / most_changes >= all.begin_of(row) ? all.change(number).row_ended : number;
  }

  // The new path against those of the rows before that ended since.
  void search_past(std::uint32_t i, double time) {
    all.neighbours_->visit_around(strip.part, i, time, farthest, buffer, [&](std::size_t j) {
      for (std::uint32_t number = in_rows_before(newest(j)); number; number = all.change(number).earlier) {
        const Change& past = all.change(number);
        if (past.time < time)
          return;
        if (meets(i, time, j, past))
          strip.blamed = number / most_changes;
      }
    });
  }

  bool meets(std::uint32_t i, double time, std::size_t j, const Change& past) const {
    const bool ordered = all.particles_->ids[i] < all.particles_->ids[j];
    const Body& own = body(i);
    Body other = body(j);
    other.elements = past.ended;
    const double start = std::max(time, past.begin);
    bool contact = false;
    all.neighbours_->visit_nearest(own, other, start, [&](const Image& image) {
      const Vec3 shift = all.step_->box.displacement(ordered ? image : -image, all.step_->offset);
      const auto j32 = static_cast<std::uint32_t>(j);
      const Query query{ordered ? i : j32, ordered ? j32 : i, shift.x(), shift.y(), start};
      const FinderResult result = all.finder_->find_between(query, ordered ? own : other, ordered ? other : own);
      contact = (result.contact() && result.time <= past.time) || result.exit == FinderExit::not_a_number ||
                time == past.time;
    });
    return contact;
  }

  template<class Visit> double visit_partners(std::size_t i, double from, const Visit& visit) {
    all.neighbours_->visit_partners(strip.part, number(), i, from, buffer, visit);
    return HUGE_VAL;
  }

  FinderResult find(const Query& query) const { return all.finder_->find(query); }
  void prefetch(std::size_t i, int stage) const {
    all.neighbours_->prefetch(i, stage);
    if (stage == 0) {
      all.so_far_->prefetch(i);
      __builtin_prefetch(&all.newest_[i], 1);
      __builtin_prefetch(&all.barred_[i], 1);
    }
  }
  void happened(const Event&, const Contact& contact) { strip.contacts.push_back(contact); }
};

bool Strips::carry_out(const StepAtHand& step, Particles& particles, StepSoFar& so_far, const Finder& finder,
                       Neighbours& neighbours, const std::vector<Event>& first, std::size_t strips) {
  step_ = &step;
  particles_ = &particles;
  so_far_ = &so_far;
  finder_ = &finder;
  neighbours_ = &neighbours;
  across_ = strips;
  cut(first);
  neighbours_->set_lookers(strips_.size()); // row by row, as they follow each other
  const std::uint64_t repairs_before = repairs;
  for (std::size_t row = 0; row < rows;) {
    if (row == 0)
      run(row, first);
    else
      run(row, left_by(row - 1));
    const bool failed = std::any_of(strips_.begin(), strips_.end(), [](const Strip& s) { return s.failed; });
    if (failed || repairs - repairs_before > most_repairs)
      return undo_all();
    row = repair(row);
  }
  return true;
}

// Where the first contacts are tells where to cut: at columns' edges, so that no column is nobody's.
void Strips::cut(const std::vector<Event>& first) {
  constexpr std::size_t enough = 64; // for a strip
  const std::size_t stride = 1 + first.size() / (enough * across_);
  const Mirror& mirror = neighbours_->mirror();
  std::vector<std::uint32_t> across;
  for (std::size_t e = 0; e < first.size(); e += stride) // they are nearly in order across, so few tell
    across.push_back(Mirror::across(mirror.line(first[e].low)));
  std::sort(across.begin(), across.end());
  const auto edge = [&](std::size_t half) { // strips are two halves wide
    return across.empty() ? 0 : mirror.column_edge(across[half % (2 * across_) * across.size() / (2 * across_)]);
  };
  if (strips_.size() != 2 * across_ + 1)
    strips_ = std::vector<Strip>(2 * across_ + 1);
  slabs_.clear();
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t k = 0; k < across_; ++k) {
      const std::uint32_t begin = edge(2 * k + row), end = edge(2 * k + 2 + row);
      slabs_.emplace_back(begin, std::uint32_t{end - begin});
    }
  slabs_.emplace_back(0, std::uint64_t{1} << 32);
  newest_.resize(particles_->size());
  barred_.resize(particles_->size());
}

void Strips::Strip::clear() {
  given.clear();
  aside.clear();
  put_off.clear();
  barred.clear();
  changes.clear();
  contacts.clear();
  touched.clear();
  farthest = 0.0;
  most_partners = 0;
  blamed = nobody;
  failed = false;
}

// Which strips of the row have the events' particles.
void Strips::find_holders(std::size_t row, std::span<const Event> events) {
  constexpr std::size_t ahead = 12, chunk = 64;
  const Mirror& mirror = neighbours_->mirror();
  const auto holder_of = [&](std::uint32_t place) {
    const std::uint32_t slot = mirror.slot(place);
    for (std::size_t s = begin_of(row); s < end_of(row); ++s)
      if (strips_[s].part.holds(slot))
        return static_cast<std::uint8_t>(s - begin_of(row));
    return no_strip;
  };
  holders_.resize(events.size());
  parallel_for(
      events.size(),
      [&](std::size_t e) {
        if (e + ahead < events.size())
          for (const std::uint32_t place : {events[e + ahead].low, events[e + ahead].high})
            mirror.prefetch(place, 0);
        holders_[e] = {holder_of(events[e].low), holder_of(events[e].high)};
      },
      chunk);
}

// The events of the strip's particles. Those that no strip of the row has both particles of are put aside by one.
void Strips::deal(std::size_t number, Strip& strip, std::span<const Event> events) {
  for (std::size_t e = 0; e < events.size(); ++e) {
    const auto [low_holder, high_holder] = holders_[e];
    const bool low = low_holder == number, high = high_holder == number;
    if (low && high) {
      strip.given.push_back(events[e]);
      continue;
    }
    if (low)
      strip.barred.push_back({events[e].time, events[e].low, events[e].low_stamp});
    if (high)
      strip.barred.push_back({events[e].time, events[e].high, events[e].high_stamp});
    if (low || (number == 0 && low_holder == no_strip))
      strip.aside.push_back(events[e]);
  }
}

// Each strip finds its own among the events, which are those of the whole row.
void Strips::run(std::size_t row, const std::vector<Event>& events) {
  double farthest = 0.0;
  for (std::size_t s = 0; s < begin_of(row); ++s)
    farthest = std::max(farthest, strips_[s].farthest);
  const std::size_t begin = begin_of(row);
  for (std::size_t s = begin; s < strips_.size(); ++s) // those of later rows have nothing to undo
    strips_[s].clear();
  for (std::size_t s = begin; s < end_of(row); ++s)
    strips_[s].part = neighbours_->mirror().part(slabs_[s].first, slabs_[s].second);
  find_holders(row, events);
  parallel_for(
      end_of(row) - begin,
      [&](std::size_t s) {
        Strip& strip = strips_[begin + s];
        Orbits orbits{*this, strip, row, farthest};
        try {
          deal(s, strip, events);
          std::sort(strip.barred.begin(), strip.barred.end(),
                    [](const Barred& a, const Barred& b) { return a.time < b.time; });
          strip.events.assign(strip.given);
          strip.changes.reserve(5 * strip.given.size() / 2);
          ContactLoop loop(*step_, orbits, strip.events);
          loop.run();
          strip.most_partners = loop.most_partners();
        } catch (...) {
          strip.failed = true; // the sequence will throw it in its order
        }
        for (const std::uint32_t i : orbits.barred)
          barred_[i] = 0;
        for (const Change& change : strip.changes)
          strip.farthest = std::max(strip.farthest, change.off);
      },
      1);
  for (std::size_t s = begin; s < end_of(row); ++s)
    neighbours_->join(strips_[s].part);
}

std::vector<Event> Strips::left_by(std::size_t row) const {
  std::vector<Event> left;
  for (std::size_t s = begin_of(row); s < end_of(row); ++s) {
    left.insert(left.end(), strips_[s].aside.begin(), strips_[s].aside.end());
    left.insert(left.end(), strips_[s].put_off.begin(), strips_[s].put_off.end());
  }
  return left;
}

// The row to go on with: the next one, unless there were conflicts with an earlier row.
std::size_t Strips::repair(std::size_t row) {
  std::vector<std::size_t> blamed;
  for (std::size_t s = begin_of(row); s < end_of(row); ++s)
    if (strips_[s].blamed != nobody)
      blamed.push_back(strips_[s].blamed);
  if (blamed.empty())
    return row + 1;
  conflicts += blamed.size();
  std::sort(blamed.begin(), blamed.end());
  blamed.erase(std::unique(blamed.begin(), blamed.end()), blamed.end());
  const std::size_t back_to = blamed.front() / across_;
  for (std::size_t s = strips_.size(); s-- > end_of(back_to);)
    undo(strips_[s]);
  for (const std::size_t s : blamed)
    if (s < end_of(back_to)) {
      ++repairs;
      undo(strips_[s]);
      strips_[s].put_off = strips_[s].given;
    }
  return back_to + 1;
}

// The last change.
void Strips::take_back(Strip& strip) {
  const Change& last = strip.changes.back();
  particles_->bodies[last.place].elements = last.ended;
  so_far_->take_back(last.place, last.begin);
  neighbours_->restore(strip.part, last.place, last.mark);
  newest_[last.place] = last.earlier;
  if (!last.earlier)
    strip.touched.pop_back();
  strip.changes.pop_back();
}

void Strips::undo(Strip& strip) {
  strip.contacts.clear();
  strip.farthest = 0.0;
  if (strip.changes.empty()) // it may not have run in this step: its part is of another mirror
    return;
  while (!strip.changes.empty())
    take_back(strip);
  neighbours_->join(strip.part); // the lines were made anew
}

bool Strips::undo_all() {
  for (std::size_t s = strips_.size(); s-- > 0;)
    undo(strips_[s]);
  return false;
}

std::size_t Strips::contacts() const {
  std::size_t count = 0;
  for (const Strip& strip : strips_)
    count += strip.contacts.size();
  return count;
}

void Strips::list_touched(std::vector<std::uint32_t>& touched) const {
  for (const Strip& strip : strips_)
    touched.insert(touched.end(), strip.touched.begin(), strip.touched.end());
}

std::uint64_t Strips::most_partners() const {
  std::uint64_t most = 0;
  for (const Strip& strip : strips_)
    most = std::max(most, strip.most_partners);
  return most;
}

std::size_t Strips::bytes() const {
  std::size_t total =
      newest_.capacity() * sizeof(std::uint32_t) + barred_.capacity() + holders_.capacity() * sizeof(Holders);
  for (const Strip& s : strips_)
    total += (s.given.capacity() + s.aside.capacity() + s.put_off.capacity()) * sizeof(Event) + s.events.bytes() +
             s.barred.capacity() * sizeof(Barred) + s.changes.capacity() * sizeof(Change) +
             s.contacts.capacity() * sizeof(Contact);
  return total;
}

} // namespace keeler
