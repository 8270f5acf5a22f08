#include <keeler/finders/finders.hpp>

#include <keeler/collision/restitution.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

namespace finders_test {

using namespace keeler;
using namespace keeler::finders;

namespace {

// Runs a finder by name on one pair.
FinderResult ask(const std::string& name, const Pair& pair, const Frequencies& f) {
  const std::unique_ptr<Finder> finder = make_finder(name);
  const std::vector<Body> bodies = {{pair.lo, 0.5 * pair.radius_sum, 1.0}, {pair.hi, 0.5 * pair.radius_sum, 1.0}};
  DriftStep step(f, pair.end - pair.step, pair.end, 100.0);
  step.bodies = bodies;
  finder->begin(step);
  return finder->find({0, 1, 0.0, 0.0, pair.start});
}

FinderResult certified(const Pair& pair, const Frequencies& f) {
  return ask("certified", pair, f);
}

// A pair that touches with a given depth of closest approach at a chosen time: |d| has its minimum R − depth there.
Pair grazing_pair(RandomStream& random, const Frequencies& f, double step, double depth, double speed) {
  Pair pair;
  pair.radius_sum = 2.0;
  pair.step = step;
  pair.start = -0.5 * step;
  pair.end = 0.5 * step;
  const double when = (random.uniform() - 0.5) * step * 0.8;
  Vec3 d(random.normal(), random.normal(), random.normal());
  d *= (pair.radius_sum - depth) / d.norm();
  Vec3 v(random.normal(), random.normal(), random.normal());
  v -= d * (v.dot(d) / d.squaredNorm());
  v *= speed / v.norm();
  pair.lo = {};
  pair.hi = elements_from({d, v}, f, Rotation(f, when));
  return pair;
}

// The relative motion in extended precision, and its deepest point before a time by a dense scan with bisection: the
// twin of the finders. `closing` at a time, `deepest` over approaching parts only: a pair that separates from contact
// is no hit.
class Twin {
public:
  using Real = long double;

  Twin(const Pair& pair, const Frequencies& f) : pair_(pair), f_(f), el_(pair.hi - pair.lo) {}

  Real gap(Real t) const { return at(t).first; }
  Real closing(Real t) const { return at(t).second; }

  /// Returns the smallest |d|² − R² that an approach reaches in [start, end].
  Real deepest(Real end, int points) const {
    Real least = HUGE_VALL, before = pair_.start;
    for (int k = 1; k <= points && end > pair_.start; ++k) {
      const Real now = pair_.start + (end - pair_.start) * k / points;
      if (closing(before) < 0) {
        Real low = now;
        if (closing(now) >= 0) {
          Real a = before;
          for (int step = 0; step < 80; ++step) {
            const Real middle = (a + low) / 2;
            (closing(middle) < 0 ? a : low) = middle;
          }
        }
        least = std::min(least, gap(low));
      }
      before = now;
    }
    return least;
  }

  /// Returns a bound on the error of |d|² − R² by rounding of the elements: some units in the last place of its terms.
  Real rounding() const {
    const Real scale = std::max({std::fabs(el_.guiding_x), std::fabs(el_.guiding_y), 2 * el_.eccentricity(),
                                 el_.inclination(), pair_.radius_sum});
    return 32 * 2.2e-16L * pair_.radius_sum * scale;
  }

private:
  std::pair<Real, Real> at(Real t) const {
    const Real k = f_.kappa, n = f_.nu, s = (4 - k * k) / 2;
    const Real ec = el_.e_cos * std::cos(k * t) - el_.e_sin * std::sin(k * t);
    const Real es = el_.e_sin * std::cos(k * t) + el_.e_cos * std::sin(k * t);
    const Real z = el_.i_sin * std::cos(n * t) + el_.i_cos * std::sin(n * t);
    const Real vz = n * (el_.i_cos * std::cos(n * t) - el_.i_sin * std::sin(n * t));
    const Real x = el_.guiding_x - ec, y = el_.guiding_y - s * el_.guiding_x * t + 2 / k * es;
    return {x * x + y * y + z * z - static_cast<Real>(pair_.radius_sum) * pair_.radius_sum,
            2 * (x * k * es + y * (2 * ec - s * el_.guiding_x) + z * vz)};
  }

  Pair pair_;
  Frequencies f_;
  Elements el_;
};

} // namespace

TEST_CASE("the certified finder finds every first contact, grazing ones too, and invents none") {
  RandomStream random(11, RandomPurpose::position, 0);
  int hits = 0, misses = 0, max_passes = 0;
  for (const Frequencies f : {Frequencies{1.0, 1.0}, Frequencies{0.95, 1.05}, Frequencies{1.0, 3.6}})
    for (const double step : {two_pi * 1e-3, two_pi * 1e-2, two_pi * 0.1, two_pi * 0.2})
      for (const double depth : {0.3, 1e-3, 1e-6, 1e-9, 1e-12, -1e-12, -1e-9, -1e-6, -1e-2})
        for (int k = 0; k < 30; ++k) {
          const Pair pair = grazing_pair(random, f, step, depth, std::pow(10.0, -2.0 + 3.0 * random.uniform()));
          const FinderResult result = certified(pair, f);
          const Twin twin(pair, f);
          REQUIRE(result.exit != FinderExit::gave_up);
          max_passes = std::max(max_passes, result.iterations);
          // twice the depth that the search may miss: see search/certified.hpp
          const int sinks = 1 + result.iterations / 1024;
          const auto allowed = sinks * twin.rounding();
          if (result.contact()) {
            ++hits;
            CHECK(twin.gap(result.time) <= allowed);
            CHECK(twin.closing(result.time) <= 1e-12L);
            CHECK(twin.deepest(result.time, 100) >= (result.exit == FinderExit::hit ? -allowed : -HUGE_VALL));
          } else {
            ++misses;
            CHECK(twin.deepest(pair.end, 100) >= -allowed);
          }
        }
  CHECK(hits > 500);
  CHECK(misses > 500);
  MESSAGE("most passes of a search: " << max_passes);
}

TEST_CASE("after a bounce the pair is not found again at once, and its later contact is") {
  const Frequencies f{1.0, 1.0};
  RandomStream random(3, RandomPurpose::position, 1);
  int bounces = 0;
  for (int k = 0; k < 2000; ++k) {
    Pair pair = grazing_pair(random, f, 0.3, 0.5, 20.0);
    FinderResult first = certified(pair, f);
    if (first.exit != FinderExit::hit || Twin(pair, f).gap(pair.start) < 0)
      continue; // overlaps at the start
    ++bounces;
    const Rotation r(f, first.time);
    const State s = state_at(pair.hi, f, r);
    const Vec3 n = s.position.normalized();
    kick(pair.hi, -1.5 * s.velocity.dot(n) * n, f, r); // ε = 0.5
    pair.start = first.time;
    const FinderResult second = certified(pair, f);
    if (second.contact())
      CHECK(second.time > first.time);
    CHECK(second.exit != FinderExit::gave_up);
  }
  CHECK(bounces > 500);
}

TEST_CASE("pairs that stay at contact within rounding end their search") {
  const Frequencies f{1.0, 1.0};
  Pair pair;
  pair.step = 0.1, pair.start = -0.05, pair.end = 0.05;
  // |d|² = e² cos² + 4 e² sin² + i² sin²(…) is constant for i = √3 e in phase
  pair.hi.e_cos = 2.0;
  pair.hi.i_sin = std::sqrt(3.0) * 2.0;
  pair.radius_sum = std::sqrt(pair.hi.e_cos * pair.hi.e_cos + pair.hi.i_sin * pair.hi.i_sin);
  CHECK(certified(pair, f).iterations < 100000);
  // slope exactly zero at time zero
  pair.hi = elements_from({{3.0, 4.0, 0.0}, {0.5, -0.375, 0.0}}, f, Rotation(f, 0.0));
  pair.radius_sum = 5.0;
  pair.start = 0.0;
  CHECK(certified(pair, f).iterations < 100000);
}

TEST_CASE("an element that is not a number never reads as a miss") {
  const Frequencies f{1.0, 1.0};
  for (const FinderEntry& entry : finder_table())
    for (double Elements::*element : {&Elements::guiding_x, &Elements::guiding_y, &Elements::e_cos, &Elements::e_sin,
                                      &Elements::i_sin, &Elements::i_cos})
      for (const double start : {-0.1, 0.05})
        for (const bool low : {false, true}) {
          CAPTURE(entry.name);
          Pair pair;
          pair.hi = {4.0, 1.0, 0.5, 0.2, 0.3, 0.1};
          Elements& elements = low ? pair.lo : pair.hi;
          elements.*element = std::nan("");
          pair.radius_sum = 1.0;
          pair.start = start, pair.end = 0.1, pair.step = 0.2;
          CHECK(ask(entry.name, pair, f).exit == FinderExit::not_a_number);
        }
}

TEST_CASE("linear-full finds ordinary contacts at a small step") {
  const Frequencies f{1.0, 1.0};
  RandomStream random(5, RandomPurpose::position, 0);
  int found = 0, all = 0; // times to |d² − R²| < 1e-8 R² over its slope of about 50
  for (int k = 0; k < 1000; ++k) {
    const Pair pair = grazing_pair(random, f, two_pi * 1e-2, 0.1, 30.0 + random.uniform());
    const FinderResult exact = certified(pair, f);
    if (exact.exit != FinderExit::hit)
      continue;
    ++all;
    const FinderResult linear = ask("linear-full", pair, f);
    found += linear.contact() && std::fabs(linear.time - exact.time) < 1e-8;
  }
  CHECK(all > 200);
  CHECK(found == all);
}

} // namespace finders_test
