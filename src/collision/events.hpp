// The pending contacts of one drift, in the order that defines its result: time, then lower id, higher id and image.
// The next event is the smallest pending one, so an event created at its creator's own time follows it, and ties are
// the same on every machine and for any number of threads.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace keeler::collision {

/// A predicted contact, or, if both particles are one, its re-prediction. Valid while neither particle has changed its
/// velocity since: while both event counts (velocity changes in the step) are as at the prediction.
struct Event {
  double time = 0.0; ///< relative to the epoch, rad
  std::uint64_t low_id = 0, high_id = 0;
  Image image;                                 ///< of the particle with the higher id
  std::uint32_t low = 0, high = 0;             ///< indices in the store
  std::uint32_t low_count = 0, high_count = 0; ///< event counts at the prediction

  bool is_reprediction() const { return low == high; }
  auto key() const { return std::tuple(time, low_id, high_id, image.nx, image.ny); }
  friend bool operator<(const Event& a, const Event& b) {
    return a.time != b.time ? a.time < b.time : a.key() < b.key();
  }
};

/// A sorted list of the events known at the start of the step, and a small heap of later ones: most are known at the
/// start. Invalid events stay until they come up (lazy deletion: Lubachevsky 1991), so the caller compares event
/// counts.
class EventQueue {
public:
  bool empty() const { return next_ == order_.size() && later_.empty(); }
  /// Replaces all events. Precondition: fewer than 2³² of them.
  void assign(std::span<const Event> events);
  void add(const Event& event);
  /// Removes and returns the earliest event. Precondition: !empty().
  Event take_first();

  std::size_t bytes() const {
    return (order_.capacity() + later_.capacity()) * sizeof(Turn) + events_.capacity() * sizeof(Event);
  }

private:
  struct Turn { // small, to be sorted fast
    double time;
    std::uint32_t number; // index in events_
  };
  bool comes_before(const Turn& a, const Turn& b) const {
    return a.time != b.time ? a.time < b.time : events_[a.number] < events_[b.number];
  }

  std::vector<Event> events_; // first the events known at the start, then later ones
  std::vector<Turn> order_;
  std::size_t next_ = 0;
  std::vector<Turn> later_;         // a binary heap, earliest first
  std::vector<std::uint32_t> free_; // indices of later events that were taken
};

} // namespace keeler::collision
