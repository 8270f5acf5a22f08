// The pending contacts of one drift, in the one order that defines the answer: time, then lower id, higher id and
// image. The next event is the smallest of those pending, so one created at its creator's own time comes after it, and
// ties are the same on every machine and for any number of threads.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace keeler {

/// A predicted contact; or, with the same particle twice, that it is to look for contacts again. It holds as long as
/// neither has changed its velocity since.
struct Event {
  double time = 0.0; ///< relative to the epoch, rad
  std::uint64_t low_id = 0, high_id = 0;
  Image image;                                 ///< of the particle with the higher id
  std::uint32_t low = 0, high = 0;             ///< places in the store
  std::uint32_t low_stamp = 0, high_stamp = 0; ///< velocity changes of each when predicted

  bool is_look() const { return low == high; }
  auto key() const { return std::tuple(time, low_id, high_id, image.nx, image.ny); }
  friend bool operator<(const Event& a, const Event& b) {
    return a.time != b.time ? a.time < b.time : a.key() < b.key();
  }
};

/// What was known at the start, sorted, and a small heap of what came later: most are known when a step begins, and
/// tell which particles to fetch ahead. Stale events stay until they come up, to be deleted then (lazy deletion:
/// Lubachevsky 1991): the caller compares stamps.
class EventQueue {
public:
  bool empty() const { return next_ == order_.size() && later_.empty(); }
  /// Replaces everything by these events.
  void assign(std::span<const Event> events);
  void add(const Event& event);
  /// Removes the earliest event.
  Event take_first();

  std::size_t bytes() const {
    return (order_.capacity() + later_.capacity()) * sizeof(Turn) + events_.capacity() * sizeof(Event);
  }

  /// One of the events that are likely to come up soon, or null.
  const Event* ahead(std::size_t by) const {
    return next_ + by < order_.size() ? &events_[order_[next_ + by].number] : nullptr;
  }

private:
  struct Turn { // small, to be sorted fast
    double time;
    std::uint32_t number; // of the event
  };
  bool comes_before(const Turn& a, const Turn& b) const {
    return a.time != b.time ? a.time < b.time : events_[a.number] < events_[b.number];
  }

  std::vector<Event> events_; // the first ones, and behind them those that came later
  std::vector<Turn> order_;
  std::size_t next_ = 0;
  std::vector<Turn> later_;         // a binary heap, earliest first
  std::vector<std::uint32_t> free_; // numbers of those that came later and were taken
};

} // namespace keeler
