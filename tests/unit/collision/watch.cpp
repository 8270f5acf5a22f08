// An observer of a drift receives equal calls in equal order for any number of threads, in whatever step it is
// registered.
#include "unit/collision/ring.hpp"
#include "unit/collision/twin.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/finders/finder.hpp>

namespace watch_test {

using namespace keeler;

namespace {

struct Calls : test::Recorder {
  struct Search {
    std::uint32_t low, high;
    double shift_x, shift_y, start;
    friend bool operator==(const Search&, const Search&) = default;
  };
  std::vector<Search> searches;
  std::vector<std::size_t> changes;

  void searched(const finders::Query& q, const finders::FinderResult&) override {
    searches.push_back({q.low, q.high, q.shift_x, q.shift_y, q.start});
  }
  void changed(std::size_t particle) override { changes.push_back(particle); }
};

// Returns the calls of six steps, observed from step `first` on.
Calls watch_from(int first, const Patch& patch, double step) {
  test::Ring ring(patch, {}, step);
  ring.keeps_neighbours = true;
  Calls calls;
  for (int k = 0; k < 6; ++k) {
    ring.observer = k >= first ? &calls : nullptr;
    ring.advance();
  }
  return calls;
}

} // namespace

TEST_CASE("the same searches, contacts and changes in the same order on 1, 2 and 3 threads") {
  const int before = threads();
  test::Scenario s;
  s.count = 12000; // several blocks of every loop
  for (const double step : {two_pi * 5e-4, two_pi * 5e-3}) {
    const Patch patch = test::make_patch(s, 1);
    for (const int first : {0, 1, 3}) {
      CAPTURE(step);
      CAPTURE(first);
      set_threads(1);
      const Calls expected = watch_from(first, patch, step);
      CHECK(expected.searches.size() > 100);
      CHECK(expected.records.size() > 10);
      for (const int count : {2, 3}) {
        CAPTURE(count);
        set_threads(count);
        const Calls calls = watch_from(first, patch, step);
        CHECK(calls.searches.size() == expected.searches.size());
        CHECK((calls.searches == expected.searches));
        CHECK((calls.changes == expected.changes));
        CHECK(calls.records.size() == expected.records.size());
        CHECK(test::same_records(calls.records, expected.records) == expected.records.size());
      }
    }
  }
  set_threads(before);
}

} // namespace watch_test
