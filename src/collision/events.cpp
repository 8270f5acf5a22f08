#include <keeler/collision/events.hpp>

#include <algorithm>

namespace keeler {
namespace {

bool later(const Event& a, const Event& b) {
  return b < a;
}

} // namespace

void EventQueue::assign(std::span<Event> events) {
  std::sort(events.begin(), events.end());
  first_ = events;
  next_ = 0;
  later_.clear();
}

void EventQueue::add(const Event& event) {
  later_.push_back(event);
  std::push_heap(later_.begin(), later_.end(), later);
}

Event EventQueue::take_first() {
  if (later_.empty() || (next_ < first_.size() && first_[next_] < later_.front()))
    return first_[next_++];
  std::pop_heap(later_.begin(), later_.end(), later);
  const Event first = later_.back();
  later_.pop_back();
  return first;
}

} // namespace keeler
