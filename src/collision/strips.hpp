// The contacts of one step on several threads, in place, with the bits of the sequential order.
//
// The box is cut across into strips with as many first contacts each, one for a thread. A strip carries out, in order,
// what lies in it with everything that the new orbits may touch, and puts off the rest: a contact near its edge, and
// all that follows for its two particles. What was put off is carried out by a second row of strips, cut through the
// middles of the first ones, and what these put off by a last one that is the whole box.
//
// Two strips of a row never touch, since new orbits stay inside. But a contact that was put off may come before one
// that was carried out, and have a say in it. So every new orbit of a later row is searched against the paths of
// earlier rows that ended after it began. A contact there, or an end at the very same instant, is a conflict: then the
// earlier strip is undone, and all of the later rows, and everything that it was given is put off. When there is no
// conflict, then by induction over the events every pending contact has been found and none is made up: what has
// happened is the sequential history.
//
// What does not fit, be it an orbit too fast for nearest images, contacts of different strips at an instant of which
// one made the other, an error, or conflicts without end, is left to the sequential loop, with everything as at the
// start of the step.
#pragma once

#include "contact_loop.hpp"
#include "neighbours.hpp"

#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace keeler {

class Strips {
public:
  /// How many strips a row may have.
  static constexpr std::size_t most_strips = 120;

  /// Carries out everything that follows from the first contacts of a step, for an exact finder, in so many strips a
  /// row. Returns false when that should be done in sequence, with everything as it was.
  bool carry_out(const StepAtHand& step, Particles& particles, StepSoFar& so_far, const Finder& finder,
                 Neighbours& neighbours, const std::vector<Event>& first, std::size_t strips);

  /// How many of the step there were.
  std::size_t contacts() const;
  /// Calls visit(contact) for each of them, in the order of events. Reads nothing but ids besides.
  template<class Visit> void visit_contacts(const Visit& visit) const;
  /// Each particle that was hit, once.
  void list_touched(std::vector<std::uint32_t>& touched) const;
  /// Of one particle in one search of the step.
  std::uint64_t most_partners() const;

  std::uint64_t conflicts = 0, repairs = 0; ///< so far
  std::size_t bytes() const;

private:
  static constexpr std::size_t rows = 3;
  static constexpr std::uint64_t most_repairs = 12;       // of a step
  static constexpr std::uint32_t most_changes = 1u << 24; // of a strip
  static constexpr std::size_t nobody = ~std::size_t{0};

  /// The end of a particle's path, and what it takes to undo it.
  struct Change {
    std::uint32_t place;
    std::uint32_t earlier;   // the number of that particle's last one before; 0: none in this step
    std::uint32_t row_ended; // the same in an earlier row
    Neighbours::Mark mark;
    double begin, time; // of the path that ended
    double off;         // how far the new path may be from any before, m
    Elements ended;
  };
  /// A contact with a partner outside of the strip: from then on a particle that has not changed is not for the strip.
  struct Barred {
    double time;
    std::uint32_t place, stamp;
  };
  struct Holders { // of an event's particles: number in the row of the strip that each is in
    std::uint8_t low, high;
  };
  static constexpr std::uint8_t no_strip = 255;
  static_assert(most_strips < no_strip);
  struct alignas(64) Strip { // two threads share no line of cache
    MirrorPart part;
    std::vector<Event> given, put_off;
    std::vector<Event> aside; // of which no strip of the row has both particles
    std::vector<Barred> barred;
    std::vector<Change> changes;
    std::vector<Contact> contacts;
    std::vector<std::uint32_t> touched; // by it first of all strips
    EventQueue events;
    double farthest = 0.0; // of what its particles are off the paths they had, m
    std::uint64_t most_partners = 0;
    std::size_t blamed = nobody; // a strip of an earlier row, for a conflict
    bool failed = false;

    void clear();
  };
  struct Orbits;

  std::size_t begin_of(std::size_t row) const { return row * across_; }
  std::size_t end_of(std::size_t row) const { return std::min((row + 1) * across_, strips_.size()); }
  const Change& change(std::uint32_t number) const {
    return strips_[number / most_changes].changes[number % most_changes - 1];
  }

  void cut(const std::vector<Event>& first);
  void find_holders(std::size_t row, std::span<const Event> events);
  void deal(std::size_t number, Strip& strip, std::span<const Event> events);
  void run(std::size_t row, const std::vector<Event>& events);
  std::vector<Event> left_by(std::size_t row) const;
  std::size_t repair(std::size_t row);
  void take_back(Strip& strip);
  void undo(Strip& strip);
  bool undo_all();

  // the step at hand
  const StepAtHand* step_ = nullptr;
  Particles* particles_ = nullptr;
  StepSoFar* so_far_ = nullptr;
  const Finder* finder_ = nullptr;
  Neighbours* neighbours_ = nullptr;

  std::size_t across_ = 1;                                     // strips of the first and of the second row
  std::vector<std::pair<std::uint32_t, std::uint64_t>> slabs_; // begin and width of each strip, in 2⁻³² of the box
  std::vector<Strip> strips_;                                  // row by row
  std::vector<Holders> holders_;                               // of the row's events
  std::vector<std::uint32_t> newest_; // the number of each particle's last change, if it has a stamp
  std::vector<std::uint8_t> barred_;  // each particle from its strip of the row at hand
};

// Those of one strip are in order, and of the next ones of all strips the one with the smallest key comes first.
template<class Visit> void Strips::visit_contacts(const Visit& visit) const {
  std::vector<std::size_t> next(strips_.size());
  std::vector<double> times; // of the next ones
  const auto time_of = [&](std::size_t s) {
    return next[s] < strips_[s].contacts.size() ? strips_[s].contacts[next[s]].time : HUGE_VAL;
  };
  const auto ids_of = [&](std::size_t s) {
    const Change* both = &strips_[s].changes[2 * next[s]];
    return std::pair(step_->particles->ids[both[0].place], step_->particles->ids[both[1].place]);
  };
  for (std::size_t s = 0; s < strips_.size(); ++s)
    times.push_back(time_of(s));
  for (;;) {
    std::size_t first = 0;
    for (std::size_t s = 1; s < strips_.size(); ++s)
      if (times[s] < times[first] || (times[s] == times[first] && times[s] < HUGE_VAL && ids_of(s) < ids_of(first)))
        first = s;
    if (times[first] == HUGE_VAL)
      return;
    visit(strips_[first].contacts[next[first]++]);
    times[first] = time_of(first);
  }
}

} // namespace keeler
