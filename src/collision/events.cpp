#include <keeler/collision/events.hpp>

#include <algorithm>

namespace keeler {
namespace {

bool later(const Event& a, const Event& b) {
  return b < a;
}

} // namespace

void EventQueue::assign(std::span<const Event> events) {
  first_ = events;
  order_.clear();
  for (std::uint32_t k = 0; k < events.size(); ++k)
    order_.push_back({events[k].time, k});
  std::sort(order_.begin(), order_.end(), [&](const Turn& a, const Turn& b) {
    return a.time != b.time ? a.time < b.time : events[a.number] < events[b.number];
  });
  next_ = 0;
  later_.clear();
}

void EventQueue::add(const Event& event) {
  later_.push_back(event);
  std::push_heap(later_.begin(), later_.end(), later);
}

Event EventQueue::take_first() {
  if (later_.empty() || (next_ < order_.size() && first_[order_[next_].number] < later_.front()))
    return first_[order_[next_++].number];
  std::pop_heap(later_.begin(), later_.end(), later);
  const Event first = later_.back();
  later_.pop_back();
  return first;
}

} // namespace keeler
