// The velocity changes of each particle in the current step: how many, and when the last one was. The number is the
// collision counter of event-driven codes (Lubachevsky 1991): an event is valid while both counters are as at its
// prediction.
#pragma once

#include <keeler/collision/events.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

class StepHistory {
public:
  /// Begins a step in which no particle has changed yet. Entries of earlier steps are recognised by their step number,
  /// so this needs no pass over the particles.
  void begin_step(std::size_t particles, double begin) {
    ++step_;
    begin_ = begin;
    if (entries_.size() != particles)
      entries_.assign(particles, {});
  }

  /// Returns the number of velocity changes of particle i.
  std::uint32_t event_count(std::size_t i) const { return entries_[i].step == step_ ? entries_[i].count : 0; }
  /// Returns the time of the last one, or the begin of the step.
  double last_change(std::size_t i) const { return entries_[i].step == step_ ? entries_[i].time : begin_; }
  /// True if neither particle has changed since the event was predicted.
  bool is_valid(const Event& event) const {
    return event.low_count == event_count(event.low) && event.high_count == event_count(event.high);
  }

  void change(std::size_t i, double time) { entries_[i] = {time, step_, event_count(i) + 1}; }
  /// Notes that an earlier path of i, which began at `time`, holds again. This counts as a change, so that events
  /// predicted for the path that was rolled back stay invalid.
  void reinstate(std::size_t i, double time) { change(i, time); }
  /// Undoes the last change of i; `time` is that of the one before. Precondition: no event has been predicted since.
  void undo_last_change(std::size_t i, double time) {
    assert(event_count(i) > 0);
    entries_[i] = {time, step_, event_count(i) - 1};
  }

  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

private:
  struct Entry {
    double time = 0.0;
    std::uint32_t step = 0; // time and count belong to this step
    std::uint32_t count = 0;
  };
  std::uint32_t step_ = 0;
  double begin_ = 0.0;
  std::vector<Entry> entries_;
};

} // namespace keeler::collision
