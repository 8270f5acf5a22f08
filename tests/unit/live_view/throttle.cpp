#include "throttle.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

namespace throttle_test {

using namespace keeler::live_view;

namespace {

// Computes until the thread has had so much processor time (s).
void compute(double seconds) {
  const double until = thread_seconds() + seconds;
  while (thread_seconds() < until) {
  }
}

} // namespace

TEST_CASE("work waits for its interval, and for its fraction of the time that passes") {
  Throttle often(0.0, 0.5), costly(0.0, 1e-4), seldom(1e3, 1.0);
  CHECK(often.due());
  for (Throttle* throttle : {&often, &costly})
    throttle->spend([] { compute(0.03); });
  seldom.spend([] {});
  std::this_thread::sleep_for(std::chrono::milliseconds(70));
  CHECK(often.due());
  CHECK_FALSE(costly.due());
  CHECK_FALSE(seldom.due());
}

TEST_CASE("a fraction of the thread's processor time does not grow while the thread waits") {
  Throttle throttle(0.0, 0.5, Throttle::Of::thread_time);
  throttle.spend([] { compute(0.03); });
  std::this_thread::sleep_for(std::chrono::milliseconds(70));
  CHECK_FALSE(throttle.due());
  compute(0.031);
  CHECK(throttle.due());
  throttle.spend([] { compute(0.03); });
  bool due_elsewhere = false;
  std::this_thread::sleep_for(std::chrono::milliseconds(70));
  std::thread([&] { due_elsewhere = throttle.due(); }).join(); // another thread has another clock
  CHECK(due_elsewhere);
}

TEST_CASE("several processors share what is spent elsewhere") {
  Throttle one(0.0, 1.0), four(0.0, 1.0);
  one.spend([] {}, 100.0, 1);
  four.spend([] {}, 0.2, 4);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  CHECK_FALSE(one.due());
  CHECK(four.due());
}

} // namespace throttle_test
