// The finders of the paper, compared with its results and its public code.
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/published.hpp>

#include "draws.hpp"
#include "unit/collision/grid_pairs.hpp"

#include <keeler/cells/overlap.hpp>

#include <doctest/doctest.h>

namespace published_test {

using namespace keeler;
using namespace keeler::finders;

namespace {

// Returns the fraction of calls in a histogram from one bin on.
double fraction_from(const FinderCounts::Histogram& histogram, int first) {
  double all = 0.0, late = 0.0;
  for (int k = 0; k < FinderCounts::bins; ++k) {
    all += static_cast<double>(histogram[k]);
    late += k >= first ? static_cast<double>(histogram[k]) : 0.0;
  }
  return late / all;
}

double ratio(std::uint64_t a, std::uint64_t b) {
  return static_cast<double>(a) / static_cast<double>(b);
}

bool starts_with(const std::string& name, const char* prefix) {
  return name.rfind(prefix, 0) == 0;
}

} // namespace

TEST_CASE("the published exit codes: what the finder decided, what it found, and where it gave up") {
  using E = PublishedExit;
  for (const auto& [code, exit] : {std::pair{0, FinderExit::hit},
                                   {1, FinderExit::gave_up},
                                   {2, FinderExit::receding},
                                   {3, FinderExit::receding},
                                   {4, FinderExit::overlapping},
                                   {5, FinderExit::missed},
                                   {6, FinderExit::missed},
                                   {7, FinderExit::gave_up},
                                   {8, FinderExit::missed},
                                   {9, FinderExit::gave_up}})
    CHECK(exit_of(static_cast<E>(code)) == exit);
}

TEST_CASE("counts: by exit, in bins with an open last one, and merged") {
  FinderCounts a, b;
  a.add({FinderExit::hit, 0.0, 3, 4});
  b.add({FinderExit::hit, 0.0, 1000, 2000});
  b.add({FinderExit::missed, 0.0, 0, 1});
  a.merge(b);
  CHECK(a.of(FinderExit::hit).count == 2);
  CHECK(a.of(FinderExit::hit).by_iterations[3] == 1);
  CHECK(a.of(FinderExit::hit).by_iterations[FinderCounts::bins - 1] == 1);
  CHECK(a.total().count == 3);
  CHECK(a.total().evaluations == 2005);
  CHECK(a.total().by_evaluations[1] == 1);
}

// The sizes of the effects are taken from the paper's Figures 5 and 6 (single size, early, a thousandth of an orbit).
TEST_CASE("grid pairs of a settled state at a thousandth of an orbit: iterations and evaluations as in the paper") {
  test::Ring ring(test::equilibrium_patch(2000, 3), {}, two_pi * 1e-3);
  for (int k = 0; k < 150; ++k)
    ring.advance();
  test::AskAll all(true);
  ring.observer = &all;
  for (int k = 0; k < 20; ++k)
    ring.advance();

  CHECK(all.in_span);
  const std::uint64_t contacts = all.of("certified").counts.of(FinderExit::hit).count;
  REQUIRE(contacts > 100);
  for (const auto& a : all.asked) {
    CAPTURE(a.name);
    const auto hits = a.counts.of(FinderExit::hit), total = a.counts.total();
    CHECK(total.count == all.of("certified").counts.total().count);
    CHECK(a.counts.of(FinderExit::not_a_number).count == 0);
    CHECK(ratio(a.lost, contacts) < 0.02);
    CHECK(a.invented == 0);
    if (a.name == "original")
      CHECK(fraction_from(hits.by_iterations, 20) > 0.5);
    else
      CHECK(fraction_from(hits.by_iterations, 6) < 0.02);
    CHECK(fraction_from(total.by_iterations, 1) < 0.5); // most calls end at once
  }

  const auto passes = [&](const char* name) { return all.of(name).counts.total().iterations; };
  const auto evaluations = [&](const char* name) { return all.of(name).counts.total().evaluations; };
  const std::uint64_t calls = all.of("original").counts.total().count;
  const auto halvings = [&](const char* name) { return all.of(name).counts.total().halvings; };
  CHECK(evaluations("newton-full") <= calls + 2 * passes("newton-full") + halvings("newton-full"));
  CHECK(halvings("newton-full") > passes("newton-full"));
  CHECK(ratio(halvings("newton-full-as-coded"), passes("newton-full-as-coded")) < 0.05);
  CHECK(evaluations("newton-relative") == evaluations("newton-full")); // the same search on the same path
  CHECK(evaluations("linear-full-no-start") > 3 * evaluations("linear-full") / 2);
  for (const char* linear : {"linear-full", "linear-cubic"}) { // the tail on misses
    CHECK(fraction_from(all.of(linear).counts.of(FinderExit::gave_up).by_iterations, 10) > 0.9);
    CHECK(fraction_from(all.of(linear).counts.total().by_iterations, 10) > 0.005);
  }
}

TEST_CASE("ordinary contacts: every finder within the published tolerance of the certified one") {
  struct Compare final : collision::DriftObserver {
    std::vector<std::unique_ptr<Finder>> finders;
    const DriftStep* step = nullptr;
    int hits = 0;

    Compare() {
      for (const FinderEntry& entry : finder_table())
        finders.push_back(entry.make());
    }
    void begins(const DriftStep& now) override {
      step = &now;
      for (auto& finder : finders)
        finder->begin(now);
    }
    void changed(std::size_t k) override {
      for (auto& finder : finders)
        finder->changed(k);
    }
    void searched(const Query& query, const FinderResult& truth) override {
      if (truth.exit != FinderExit::hit)
        return;
      const Pair pair = pair_of(query, *step);
      RelativeMotion path(pair, *step);
      const double slope = std::fabs(path.at(truth.time).closing());
      if (slope < 1.0 || path.at(pair.start).closing() >= 0.0 || step->end - truth.time < 1e-5)
        return; // grazing, or lost by rule: the published finders give up on pairs that recede at first
      ++hits;
      for (std::size_t k = 0; k < finders.size(); ++k) {
        CAPTURE(finder_table()[k].name);
        const FinderResult result = finders[k]->find(query);
        REQUIRE(result.contact());
        // |d² − R²| < 1e-8 R² over its slope; and a cubic's remainder, h⁴/384 · 2e with e about 10, times 2 R
        const bool cubic = std::string(finder_table()[k].name).find("cubic") != std::string::npos;
        const double remainder = cubic ? std::pow(pair.step, 4) / 384.0 * 20.0 * 2.0 * pair.radius_sum : 0.0;
        CHECK(std::fabs(result.time - truth.time) <=
              1.1 * (1e-8 * pair.radius_sum * pair.radius_sum + remainder) / slope);
      }
    }
  } compare;
  test::Ring ring(test::equilibrium_patch(2000, 4), {}, two_pi * 1e-3);
  ring.observer = &compare;
  for (int k = 0; k < 60; ++k)
    ring.advance();
  CHECK(compare.hits > 300);
}

TEST_CASE("every finder carries a dense state through fifty steps, ever larger ones too") {
  for (const double step : {1e-3, 1e-2, 5e-2})
    for (const FinderEntry& entry : finder_table()) {
      CAPTURE(entry.name);
      CAPTURE(step);
      collision::CollisionSettings settings;
      settings.finder = entry.name;
      test::Ring ring(test::equilibrium_patch(500, 6), settings, two_pi * step);
      for (int k = 0; k < (test::sanitized ? 25 : 50); ++k)
        ring.advance();
      CHECK(ring.tally.fast > (test::sanitized ? 50 : 100));
      const bool faithful = !starts_with(entry.name, "certified");
      CHECK(cells::largest_overlap(ring.patch()).depth < (faithful ? 0.2 : 1e-11)); // misses, and no worse
    }
}

TEST_CASE("a buried pair is an event a little later in the step, never past its end, and parts") {
  const double h = two_pi * 1e-3;
  for (const FinderEntry& entry : finder_table())
    for (const double start : {-0.5 * h, 0.2 * h, std::nextafter(0.5 * h, 0.0)}) {
      CAPTURE(entry.name);
      const Frequencies f;
      const Vec3 velocity(-2.0, 0.1, 0.3);
      std::vector<Body> bodies(2, Body{{}, 1.0, 1.0});
      bodies[1].elements = elements_from({{1.2, 0.3, 0.5}, velocity}, f, Rotation(f, start));
      DriftStep step(f, -0.5 * h, 0.5 * h, 100.0);
      step.bodies = bodies;
      const auto finder = make_finder(entry.name);
      finder->begin(step);
      const FinderResult result = finder->find({0, 1, 0.0, 0.0, start});
      CHECK(result.exit == FinderExit::overlapping);
      CHECK(result.time >= start);
      CHECK(result.time < step.end);
      const std::string name = entry.name;
      const bool by_radius =
          name.find("cubic") == std::string::npos && starts_with(name, "linear") && start > step.begin;
      const double published = start + (by_radius ? 1e-3 / velocity.norm() : 1e-4 * h);
      if (name != "certified")
        CHECK(result.time == doctest::Approx(published < step.end ? published : start).epsilon(1e-12));
    }
}

} // namespace published_test
