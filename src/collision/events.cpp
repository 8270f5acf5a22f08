#include <keeler/collision/events.hpp>

#include "ablation.hpp"

#include <algorithm>
#include <cassert>

namespace keeler::collision {

void EventQueue::assign(std::span<const Event> events) {
  assert(events.size() < ~std::uint32_t{0});
  events_.assign(events.begin(), events.end());
  order_.clear();
  if (!without(Acceleration::presorting))
    for (std::uint32_t k = 0; k < events_.size(); ++k)
      order_.push_back({events_[k].time, k});
  std::sort(order_.begin(), order_.end(), [&](const Turn& a, const Turn& b) { return comes_before(a, b); });
  next_ = 0;
  later_.clear();
  free_.clear();
  if (without(Acceleration::presorting)) {
    events_.clear();
    for (const Event& event : events)
      add(event);
  }
}

void EventQueue::add(const Event& event) {
  std::uint32_t number = static_cast<std::uint32_t>(events_.size());
  if (free_.empty()) {
    events_.push_back(event);
  } else {
    number = free_.back();
    free_.pop_back();
    events_[number] = event;
  }
  later_.push_back({event.time, number});
  std::push_heap(later_.begin(), later_.end(), [&](const Turn& a, const Turn& b) { return comes_before(b, a); });
}

Event EventQueue::take_first() {
  assert(!empty());
  if (later_.empty() || (next_ < order_.size() && comes_before(order_[next_], later_.front())))
    return events_[order_[next_++].number];
  std::pop_heap(later_.begin(), later_.end(), [&](const Turn& a, const Turn& b) { return comes_before(b, a); });
  const std::uint32_t first = later_.back().number;
  later_.pop_back();
  free_.push_back(first);
  return events_[first];
}

} // namespace keeler::collision
