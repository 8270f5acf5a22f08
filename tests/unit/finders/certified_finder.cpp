// The certified finder, which solves most pairs by Newton's method, many at once, against the plain certified search;
// and identical bits for all instruction sets. KEELER_PAIRS=10000000 sets the number of pairs.
#include <keeler/finders/certified_finder.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/certified.hpp>

#include "unit/finders/allowance.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <bit>
#include <vector>

namespace certified_finder_test {

using namespace keeler;
using namespace keeler::finders;
using namespace keeler::test;

namespace {

using PlainFinder = MotionSearch<BoundedMotion, CertifiedSearch>;

// CertifiedSearch evaluates once before its first pass: a search with more evaluations was left undecided by Newton's
// method first.
bool searched(const FinderResult& result) {
  return result.evaluations > result.iterations + 1;
}

struct Comparison {
  std::uint64_t pairs = 0, asked = 0, left = 0, contacts = 0; // left: to the certified search
  std::uint64_t other_call = 0;                               // contact or none: at grazes only
  std::uint64_t wrong = 0;
  double apart = 0.0; // largest difference of f at the two times, of what rounding allows

  void compare(const PairCase& c, const FinderResult& found, const FinderResult& plain) {
    ++pairs;
    asked += found.evaluations > 0;
    left += searched(found);
    contacts += found.contact();
    const Real radius_sum = static_cast<Real>(c.bodies[0].radius) + c.bodies[1].radius;
    BernsteinTwin twin(c.bodies[0].elements, c.bodies[1].elements, c.query.shift_x, c.query.shift_y, radius_sum,
                       c.frequencies);
    const Allowance allowance(c, twin, radius_sum);
    const int thousands = std::max(found.iterations, plain.iterations) / 1024;
    const Real bound = 2 * allowance.gap * (1 + thousands);
    bool right = true;
    if (found.contact() != plain.contact()) { // neither reports a contact that the other must not miss
      ++other_call;
      right = twin.sinks(c.query.start, c.end, bound) <= 1.0;
    } else if (found.contact()) {
      const Real tick = std::fabs(twin.slope(plain.time)) * unit_roundoff * std::max(-c.begin, c.end);
      const Real apart_now = std::fabs(twin.gap(found.time) - twin.gap(plain.time)) / (bound + 2 * tick);
      apart = std::max(apart, static_cast<double>(apart_now));
      right = apart_now <= 1 && twin.sinks(c.query.start, std::max(found.time, plain.time), bound + 2 * tick) <= 1.0;
      right &= found.exit == plain.exit || std::fabs(twin.gap(c.query.start)) <= bound ||
               std::fabs(twin.slope(c.query.start)) <= allowance.closing;
    } else {
      right = found.exit != FinderExit::gave_up && found.exit != FinderExit::not_a_number;
    }
    wrong += !right;
  }
};

bool same_bits(const FinderResult& a, const FinderResult& b) {
  return a.exit == b.exit && std::bit_cast<std::uint64_t>(a.time) == std::bit_cast<std::uint64_t>(b.time) &&
         a.iterations == b.iterations && a.evaluations == b.evaluations && a.halvings == b.halvings;
}

// Compares pairs of one family, each from several start times; the step is the first pair's.
struct ManyPairs {
  std::vector<Body> bodies;
  std::vector<Query> queries;
  DriftStep step;

  ManyPairs(RandomPairs& pairs, RandomStream& random, std::size_t count) : step({}, 0.0, 0.0, 0.0) {
    for (std::size_t k = 0; k < count; ++k) {
      const PairCase c = pairs.draw();
      if (k == 0)
        step = DriftStep(c.frequencies, c.begin, c.end, c.size);
      step.tested = random.uniform() < 0.5;
      for (int again = 0; again < 3; ++again) {
        Query query = c.query;
        query.low = static_cast<std::uint32_t>(2 * k);
        query.high = query.low + 1;
        query.start = again == 0 ? step.begin : step.begin + (step.end - step.begin) * random.uniform();
        queries.push_back(query);
      }
      bodies.insert(bodies.end(), c.bodies.begin(), c.bodies.end());
    }
    step.bodies = bodies;
  }
};

constexpr InstructionSet sets[] = {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512};

} // namespace

TEST_CASE("Newton's method and the certified search give the same first contacts") {
  const std::uint64_t each = std::max<std::uint64_t>(100, pairs_asked_for() / (families - 1));
  const auto finder = make_certified_finder(InstructionSet::portable);
  PlainFinder plain;
  std::string table;
  for (int family = 0; family + 1 < families; ++family) {
    RandomPairs pairs(6, static_cast<Family>(family));
    Comparison comparison;
    for (std::uint64_t k = 0; k < each; ++k) {
      PairCase c = pairs.draw();
      bool bounced = true;
      for (int again = 0; again < 3 && bounced; ++again) {
        DriftStep step(c.frequencies, c.begin, c.end, c.size);
        step.bodies = c.bodies;
        finder->begin(step);
        plain.begin(step);
        const FinderResult found = finder->find(c.query);
        comparison.compare(c, found, plain.find(c.query));
        bounced = found.contact() && pairs.bounce(c, found.time);
      }
    }
    const char* name = family_names[static_cast<std::size_t>(family)];
    CAPTURE(name);
    CHECK(comparison.wrong == 0);
    CHECK(comparison.contacts > each / 100);
    CHECK(comparison.left < comparison.asked); // Newton's method solves some
    table += fmt::format("{:<16}{:>10} pairs, {:>9} contacts, {:>8} searched, {:>6} called otherwise, f apart {:.3f}\n",
                         name, comparison.pairs, comparison.contacts, comparison.left, comparison.other_call,
                         comparison.apart);
  }
  MESSAGE("\n" << table);
}

TEST_CASE("many at once have the bits of one at a time, on every instruction set") {
  std::size_t asked = 0, at_once = 0;
  for (int family = 0; family + 1 < families; ++family) {
    RandomPairs pairs(7, static_cast<Family>(family));
    RandomStream random(8, RandomPurpose::position, static_cast<std::uint64_t>(family));
    for (std::size_t round = 0; round < draws(2000); ++round) {
      const ManyPairs many(pairs, random, 1 + round % 9);
      std::vector<FinderResult> expected;
      for (const InstructionSet set : sets) {
        if (!supports(set))
          continue;
        const auto finder = make_certified_finder(set);
        finder->begin(many.step);
        if (expected.empty())
          for (const Query& query : many.queries)
            expected.push_back(finder->find(query));
        std::vector<FinderResult> results(many.queries.size());
        finder->find_all(many.queries, results);
        for (std::size_t k = 0; k < results.size(); ++k) {
          CAPTURE(instruction_set_name(set));
          REQUIRE(same_bits(results[k], expected[k]));
        }
      }
      for (const FinderResult& result : expected) {
        asked += result.evaluations > 0;
        at_once += result.evaluations > 0 && !searched(result);
      }
    }
  }
  MESSAGE(at_once << " of " << asked << " settled by Newton's method");
  CHECK(2 * at_once > asked);
}

TEST_CASE("hardly any pair of a ring needs the certified search") {
  const Frequencies f;
  std::string table;
  for (const double orbits : {1e-3, 5e-3, 1e-2, 2e-2, 5e-2}) {
    const double h = two_pi * orbits;
    RandomStream random(9, RandomPurpose::position, 0);
    const auto vector = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    std::vector<Body> bodies;
    std::vector<Query> queries;
    for (std::uint32_t k = 0; k < 24000; k += 2) { // radii 1, some radii an orbit of relative speed, the shear
      const Vec3 place = vector().normalized() * (2.0 + 6.0 * h * random.uniform());
      const Vec3 velocity = 2.0 * vector() - Vec3(0.0, f.shear() * place.x(), 0.0);
      bodies.push_back({{}, 1.0, 1.0});
      bodies.push_back({elements_from({place, velocity}, f, Rotation(f, -0.5 * h)), 1.0, 1.0});
      queries.push_back({k, k + 1, 0.0, 0.0, -0.5 * h});
    }
    DriftStep step(f, -0.5 * h, 0.5 * h, 100.0);
    step.bodies = bodies;
    const auto finder = make_finder("certified");
    finder->begin(step);
    std::vector<FinderResult> results(queries.size());
    finder->find_all(queries, results);
    std::size_t asked = 0, left = 0, hits = 0;
    for (const FinderResult& result : results) {
      asked += result.evaluations > 0;
      left += searched(result);
      hits += result.exit == FinderExit::hit;
    }
    CHECK(hits > 1000);
    if (orbits <= 1e-2)
      CHECK(100 * left < asked);
    table += fmt::format("{:.3f} orbit: {:.2f} % of {} pairs\n", orbits,
                         100.0 * static_cast<double>(left) / static_cast<double>(asked), asked);
  }
  MESSAGE("\n" << table);
}

TEST_CASE("a number that is none spoils its own lane only") {
  const double h = two_pi * 1e-3;
  for (const double bad : {std::nan(""), HUGE_VAL, 1e200})
    for (const InstructionSet set : sets) {
      if (!supports(set))
        continue;
      std::vector<Body> bodies;
      std::vector<Query> queries;
      for (std::uint32_t k = 0; k < 20; ++k) {
        bodies.push_back({{}, 1.0, 1.0});
        bodies.push_back({elements_from({{2.01, 0.0, 0.0}, {-10.0, 0.0, 0.0}}, {}, Rotation({}, -0.5 * h)), 1.0, 1.0});
        queries.push_back({2 * k, 2 * k + 1, 0.0, 0.0, -0.5 * h});
      }
      bodies[11].elements.e_sin = bad;
      DriftStep step({}, -0.5 * h, 0.5 * h, 100.0);
      step.bodies = bodies;
      step.tested = true;
      const auto finder = make_certified_finder(set);
      finder->begin(step);
      std::vector<FinderResult> results(queries.size());
      finder->find_all(queries, results);
      for (std::size_t k = 0; k < results.size(); ++k)
        CHECK(results[k].exit == (k == 5 ? FinderExit::not_a_number : FinderExit::hit));
    }
}

TEST_CASE("every finder of the table answers many queries as one at a time") {
  RandomPairs pairs(10, Family::hit);
  RandomStream random(11, RandomPurpose::position, 0);
  for (const FinderEntry& entry : finder_table()) {
    CAPTURE(entry.name);
    const ManyPairs many(pairs, random, 20);
    const auto finder = entry.make();
    finder->begin(many.step);
    std::vector<FinderResult> results(many.queries.size());
    finder->find_all(many.queries, results);
    for (std::size_t k = 0; k < results.size(); ++k)
      CHECK(same_bits(results[k], finder->find(many.queries[k])));
  }
}

} // namespace certified_finder_test
