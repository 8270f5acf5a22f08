// The certified finder against the certified twin: over random pairs of many families it finds every first contact and
// no false one. KEELER_PAIRS=10000000 sets the number of pairs; the default is a sample.
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>

#include "unit/finders/allowance.hpp"
#include "unit/finders/bernstein_twin.hpp"
#include "unit/finders/random_pairs.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <chrono>
#include <string>

namespace first_contacts_test {

using namespace keeler;
using namespace keeler::finders;
using namespace keeler::test;

namespace {

struct Tally {
  std::uint64_t pairs = 0, hits = 0, overlapping = 0, searched_misses = 0, rejected = 0;
  std::uint64_t missed = 0, wrong = 0; // an earlier contact was there; any claim does not hold
  double sunk = 0.0, called = 0.0;     // of the allowance: deepest unseen approach, largest |f| at a called contact
  double rounding = 0.0, slope_error = 0.0; // of gap_error and closing_error: largest error met, images left out
  int passes = 0, pieces = 0;

  void add(const Tally& o) {
    pairs += o.pairs, hits += o.hits, overlapping += o.overlapping, searched_misses += o.searched_misses;
    rejected += o.rejected;
    missed += o.missed, wrong += o.wrong;
    sunk = std::max(sunk, o.sunk), called = std::max(called, o.called);
    rounding = std::max(rounding, o.rounding), slope_error = std::max(slope_error, o.slope_error);
    passes = std::max(passes, o.passes), pieces = std::max(pieces, o.pieces);
  }
};

// Runs the table's finder on single pairs.
class Examiner {
public:
  explicit Examiner(const char* finder) : finder_(make_finder(finder)) {}

  FinderResult examine(const PairCase& c, double when, Tally& tally) {
    const FinderResult result = ask(c);
    const Real radius_sum = static_cast<Real>(c.bodies[0].radius) + c.bodies[1].radius;
    BernsteinTwin twin(c.bodies[0].elements, c.bodies[1].elements, c.query.shift_x, c.query.shift_y, radius_sum,
                       c.frequencies);
    const Allowance allowance(c, twin, radius_sum);
    if (c.query.shift_x == 0.0)
      measure_rounding(c, twin, radius_sum, when, tally);

    const double until = result.contact() ? result.time : c.end;
    const Real tick = std::fabs(twin.slope(until)) * unit_roundoff * std::max(std::fabs(c.begin), std::fabs(c.end));
    const int sinkings = 1 + result.iterations / 1024;
    const Real bound = 2 * allowance.gap * sinkings + tick;
    const double sunk = twin.sinks(c.query.start, until, bound);
    tally.missed += !(sunk <= 1.0);
    bool right = sunk <= 1.0;
    if (result.contact()) {
      const double called = static_cast<double>(twin.gap(until) / bound);
      right &= until >= c.query.start && until < c.end && called <= 1.0 && twin.slope(until) <= allowance.closing;
      right &= result.exit == FinderExit::hit || until == c.query.start;
      tally.called = std::max(tally.called, called);
    } else {
      right &= result.exit == FinderExit::missed || result.exit == FinderExit::receding;
    }
    count(result, tally);
    tally.sunk = std::max(tally.sunk, sunk);
    tally.passes = std::max(tally.passes, result.iterations);
    tally.pieces = std::max(tally.pieces, twin.pieces());
    if (!right && tally.wrong++ < complaints)
      complain(c, twin, result, sunk, bound);
    return result;
  }

  std::uint64_t complaints = 3; ///< how many to print

private:
  FinderResult ask(const PairCase& c) {
    step_ = DriftStep(c.frequencies, c.begin, c.end, c.size);
    step_.bodies = c.bodies;
    finder_->begin(step_);
    return finder_->find(c.query);
  }

  void measure_rounding(const PairCase& c, const BernsteinTwin& twin, Real radius_sum, double when,
                        Tally& tally) const {
    const Pair pair = pair_of(c.query, step_);
    const Separation now = RelativeMotion(pair, step_).at(when);
    const Real distance = twin.distance(when), speed = twin.speed(when);
    const auto ratio = [](Real error, Real allowed) { return static_cast<double>(std::fabs(error) / allowed); };
    tally.rounding = std::max(tally.rounding, ratio(now.gap(pair.radius_sum) - twin.gap(when),
                                                    Allowance::gap_error(distance, radius_sum, twin)));
    tally.slope_error = std::max(
        tally.slope_error, ratio(now.closing() - twin.slope(when), Allowance::closing_error(distance, speed, twin)));
  }

  static void count(const FinderResult& result, Tally& tally) {
    ++tally.pairs;
    tally.hits += result.exit == FinderExit::hit;
    tally.overlapping += result.exit == FinderExit::overlapping;
    tally.rejected += result.evaluations == 0;
    tally.searched_misses += !result.contact() && result.evaluations > 0;
  }

  static void complain(const PairCase& c, const BernsteinTwin& twin, const FinderResult& result, double sunk,
                       Real bound) {
    const Real at = result.contact() ? result.time : c.end;
    MESSAGE(fmt::format("{} at {:.17g} of [{:.17g}, {:.17g}), {} passes, {} evaluations: sinks {:.3g}, f = {:.3g}, "
                        "f' = {:.3g}, bound {:.3g}; kappa {} nu {}",
                        name_of(result.exit), result.time, c.query.start, c.end, result.iterations, result.evaluations,
                        sunk, static_cast<double>(twin.gap(at)), static_cast<double>(twin.slope(at)),
                        static_cast<double>(bound), c.frequencies.kappa, c.frequencies.nu));
  }

  std::unique_ptr<Finder> finder_;
  DriftStep step_ = DriftStep(PairCase().frequencies, 0.0, 0.0, 0.0);
};

std::string row(const char* name, const Tally& t) {
  return fmt::format("{:<16}{:>10}{:>10}{:>10}{:>10}{:>10}{:>7}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}{:>8}{:>8}\n", name,
                     t.pairs, t.hits, t.overlapping, t.searched_misses, t.rejected, t.wrong, t.sunk, t.called,
                     t.rounding, t.slope_error, t.passes, t.pieces);
}

} // namespace

TEST_CASE("the certified finder misses no first contact and invents none: proven pair by pair") {
  const std::uint64_t each = std::max<std::uint64_t>(100, pairs_asked_for() / (families - 1));
  const auto clock_start = std::chrono::steady_clock::now();
  std::array<Tally, families> tallies;
  Tally& bounced = tallies[static_cast<std::size_t>(Family::bounced)];
  Examiner examiner("certified");
  for (int family = 0; family + 1 < families; ++family) {
    RandomPairs pairs(2, static_cast<Family>(family));
    RandomStream times(3, RandomPurpose::position, static_cast<std::uint64_t>(family));
    Tally& tally = tallies[static_cast<std::size_t>(family)];
    for (std::uint64_t k = 0; k < each; ++k) {
      PairCase c = pairs.draw();
      const auto time = [&] { return c.begin + (c.end - c.begin) * times.uniform(); };
      FinderResult result = examiner.examine(c, time(), tally);
      for (int again = 0; again < 3 && result.contact() && pairs.bounce(c, result.time); ++again)
        result = examiner.examine(c, time(), bounced);
    }
  }
  Tally all;
  std::string table =
      fmt::format("{:<16}{:>10}{:>10}{:>10}{:>10}{:>10}{:>7}{:>9}{:>9}{:>9}{:>9}{:>8}{:>8}\n", "family", "pairs",
                  "hits", "at start", "missed", "rejected", "wrong", "sunk", "called", "f", "f'", "passes", "pieces");
  for (int family = 0; family < families; ++family) {
    const Tally& tally = tallies[static_cast<std::size_t>(family)];
    table += row(family_names[static_cast<std::size_t>(family)], tally);
    all.add(tally);
    CHECK(tally.wrong == 0);
    CHECK(tally.hits > each / 100); // the family serves its purpose
    CHECK(tally.searched_misses > each / 100);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - clock_start;
  MESSAGE("\n" << table << row("all", all) << fmt::format("{:.1f} s", seconds.count()));
  CHECK(all.rounding <= 1.0); // gap_error and closing_error are bounds
  CHECK(all.slope_error <= 1.0);
}

TEST_CASE("straight lines rule out no first contact, over the step and over any while in it") {
  const auto finder = make_finder("certified");
  for (int family = 0; family + 1 < families; ++family) {
    CAPTURE(family_names[static_cast<std::size_t>(family)]);
    RandomPairs pairs(4, static_cast<Family>(family));
    RandomStream shares(5, RandomPurpose::position, static_cast<std::uint64_t>(family));
    int contacts = 0, ruled_out = 0, lost = 0;
    for (int k = 0; k < static_cast<int>(draws(20000)); ++k) {
      const PairCase c = pairs.draw();
      DriftStep step(c.frequencies, c.begin, c.end, c.size);
      step.bodies = c.bodies;
      finder->begin(step);
      const FinderResult result = finder->find(c.query);
      const auto ruled_out_between = [&](double begin, double end) {
        return !step.straight_line.may_touch_soon(c.bodies[0], c.bodies[1], c.query.shift_x, c.query.shift_y,
                                                  Rotation(c.frequencies, begin), end - begin);
      };
      const double until = result.contact() ? result.time : c.end;
      const double begin = c.query.start + (until - c.query.start) * shares.uniform();
      if (result.contact()) {
        ++contacts;
        lost += !may_touch(c.query, c.bodies[0], c.bodies[1], step) || ruled_out_between(begin, until);
      } else {
        ruled_out += ruled_out_between(begin, until);
      }
    }
    CHECK(lost == 0);
    CHECK(contacts > static_cast<int>(draws(200)));
    CHECK(ruled_out > static_cast<int>(draws(200))); // the test is effective
  }
}

TEST_CASE("the twin convicts a finder that misses contacts") {
  Examiner examiner("linear-full");
  examiner.complaints = 0;
  for (const Family family : {Family::grazing, Family::tidal}) {
    RandomPairs pairs(2, family);
    Tally tally;
    for (int k = 0; k < 1000; ++k)
      examiner.examine(pairs.draw(), 0.0, tally);
    CHECK(tally.missed > 20);
  }
}

TEST_CASE("the pairs pictured in docs/theory/finders.md") {
  PairCase c;
  c.begin = c.query.start = -0.2 * pi;
  c.end = 0.2 * pi;
  c.size = 100.0;
  c.query.high = 1;
  c.bodies[0].radius = c.bodies[1].radius = 1.0;
  const auto ask = [&](const char* finder) {
    Examiner examiner(finder);
    examiner.complaints = 0;
    Tally tally;
    return examiner.examine(c, 0.0, tally);
  };
  SUBCASE("Newton passes the first contact") {
    c.frequencies = {1.0, 3.6};
    c.bodies[1].elements = {-1.075, -4.593, 0.251, 2.198, 1.722, 2.907};
    CHECK(ask("certified").time == doctest::Approx(-0.2009).epsilon(1e-3));
  }
  SUBCASE("the linear search ends at a closest approach") {
    c.bodies[1].elements = {-3.391, 1.38, -3.821, 0.719, 0.0, 0.0};
    CHECK(ask("certified").time == doctest::Approx(0.3284).epsilon(1e-3));
    CHECK(!ask("linear-full").contact());
  }
}

} // namespace first_contacts_test
