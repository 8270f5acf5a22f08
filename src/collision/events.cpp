#include <keeler/collision/events.hpp>

#include <algorithm>

namespace keeler {
namespace {

bool later(const Event& a, const Event& b) {
  return b.key() < a.key();
}

} // namespace

void EventQueue::add(const Event& event) {
  heap_.push_back(event);
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void EventQueue::assign(std::vector<Event>&& events) {
  heap_ = std::move(events);
  std::make_heap(heap_.begin(), heap_.end(), later);
}

Event EventQueue::take_first() {
  std::pop_heap(heap_.begin(), heap_.end(), later);
  const Event first = heap_.back();
  heap_.pop_back();
  return first;
}

} // namespace keeler
