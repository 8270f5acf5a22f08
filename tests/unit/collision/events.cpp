// The queue of pending contacts against its reference implementation: a plain list, searched for the smallest key.
#include <keeler/collision/events.hpp>
#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace events_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

struct Draws {
  RandomStream random;
  std::uint32_t events = 0;

  explicit Draws(std::uint64_t seed) : random(seed, RandomPurpose::sample, 0) {}

  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  }
  std::int32_t step() { return static_cast<std::int32_t>(below(3)) - 1; }

  // Draws from few times, ids and images, so that each decides often. The index distinguishes events with equal keys.
  Event event(std::size_t times) {
    Event event;
    event.time = static_cast<double>(below(times)) - 0.5 * static_cast<double>(times);
    event.low_id = below(4);
    event.high_id = event.low_id + 1 + below(4);
    event.image = {step(), step()};
    event.low = events++;
    return event;
  }

  std::vector<Event> some(std::size_t count, std::size_t times) {
    std::vector<Event> all(count);
    for (Event& one : all)
      one = event(times);
    return all;
  }
};

// The reference implementation.
struct Pending {
  std::vector<Event> events;

  auto first_key() const {
    return std::min_element(events.begin(), events.end(),
                            [](const Event& a, const Event& b) { return a.key() < b.key(); })
        ->key();
  }

  // Removes an event. Returns false if it was not pending with that key.
  bool take(const Event& event) {
    const auto at = std::find_if(events.begin(), events.end(), [&](const Event& e) { return e.low == event.low; });
    if (at == events.end() || at->key() != event.key())
      return false;
    events.erase(at);
    return true;
  }
};

} // namespace

TEST_CASE(
    "events come in the order of time, ids and image, however many times are equal and whenever they were added") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Draws draws(seed);
    const std::size_t times = seed % 3 == 0 ? 1 : seed % 3 == 1 ? 5 : 100000;
    EventQueue queue;
    for (int again = 0; again < 2; ++again) { // a second step must not see events of the first
      Pending pending{draws.some(draws.below(120), times)};
      queue.assign(pending.events);
      for (int act = 0; act < 400; ++act) {
        REQUIRE(queue.empty() == pending.events.empty());
        if (queue.empty() || draws.below(5) < 2) {
          pending.events.push_back(draws.event(times)); // some are earlier than events that have been taken
          queue.add(pending.events.back());
          continue;
        }
        const auto first = pending.first_key();
        const Event taken = queue.take_first();
        REQUIRE((taken.key() == first));
        REQUIRE(pending.take(taken));
      }
    }
  }
}

} // namespace events_test
