#include <keeler/finders/motion/cubic.hpp>
#include <keeler/finders/motion/relative.hpp>

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace motions_test {

using namespace keeler;
using namespace keeler::finders;

namespace {

// Two particles in one step; the second one is near through an image some boxes away.
struct Meeting {
  std::vector<Body> bodies;
  DriftStep step;
  Query query;

  Meeting(std::uint64_t draw, const Frequencies& f, double h)
      : step(f, -0.5 * h, 0.5 * h, 1000.0), query{0, 1, 0.0, 0.0, -0.5 * h} {
    RandomStream random(7, RandomPurpose::position, draw);
    query.shift_x = 400.0 * random.normal();
    query.shift_y = 300.0 * random.normal();
    for (int k = 0; k < 2; ++k) {
      const double x = random.normal(), y = random.normal(), ec = random.normal(), es = random.normal(),
                   is = random.normal(), ic = random.normal();
      bodies.push_back({{5.0 * x, 5.0 * y, 2.0 * ec, 2.0 * es, is, ic}, 1.0, 1.0});
    }
    bodies[1].elements.guiding_x -= query.shift_x;
    bodies[1].elements.guiding_y -= query.shift_y;
    step.bodies = bodies;
  }
  Meeting(const Meeting&) = delete;

  Pair pair() const { return pair_of(query, step); }
  Elements relative() const { return pair().hi - pair().lo; }
};

const Frequencies all_frequencies[] = {{1.0, 1.0}, {0.99458, 1.00539}, {1.0, 3.6}};
const double all_steps[] = {two_pi * 1e-4, two_pi * 1e-3, two_pi * 1e-2, two_pi * 0.1};

// Rounding errors of differences and rates of coordinates of some hundred metres.
constexpr double rounding = 2e-12;

void check_equal(const Separation& a, const Separation& b) {
  CHECK((a.d - b.d).cwiseAbs().maxCoeff() < rounding);
  CHECK((a.v - b.v).cwiseAbs().maxCoeff() < rounding);
}

// A Hermite cubic through values and slopes at both ends of h is off by at most h⁴/384 max|x⁗|, its slope by
// h³ √3/216 max|x⁗| (Birkhoff & Priver 1967). Here x⁗ is at most κ⁴e in x, 2κ³e in y and ν⁴i in z. Beyond that, the
// slopes of the fit divide roundings by h.
template<class Motion> void check_cubic(const Meeting& m, Motion& cubic) {
  const Frequencies& f = m.step.frequencies;
  const Pair pair = m.pair();
  const FullMotion full(pair, m.step);
  const double h = m.step.end - m.step.begin, e = m.relative().eccentricity(), i = m.relative().inclination();
  const Vec3 fourth(std::pow(f.kappa, 4) * e, 2.0 * std::pow(f.kappa, 3) * e, std::pow(f.nu, 4) * i);
  for (int k = 0; k <= 10; ++k) {
    const double t = m.step.begin + h * k / 10.0;
    const Separation exact = full.at(t), fit = cubic.at(t);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::fabs(fit.d[axis] - exact.d[axis]) <= fourth[axis] * std::pow(h, 4) / 384.0 + rounding);
      CHECK(std::fabs(fit.v[axis] - exact.v[axis]) <=
            fourth[axis] * std::pow(h, 3) * std::sqrt(3.0) / 216.0 + rounding * (1.0 + 3.0 / h));
    }
  }
}

template<class Check> void for_all_meetings(const Check& check) {
  std::uint64_t draw = 0;
  for (const Frequencies& f : all_frequencies)
    for (const double h : all_steps)
      for (int k = 0; k < 20; ++k) {
        const Meeting m(++draw, f, h);
        check(m);
      }
}

} // namespace

TEST_CASE("the relative epicycle is the difference of both particles' own, through images") {
  for_all_meetings([](const Meeting& m) {
    const Pair pair = m.pair();
    for (const double t : {m.step.begin, 0.3 * m.step.end, m.step.end})
      check_equal(RelativeMotion(pair, m.step).at(t), FullMotion(pair, m.step).at(t));
  });
}

TEST_CASE("stored start states are the evaluation at the start to rounding, and serve there alone") {
  for_all_meetings([](const Meeting& m) {
    Pair pair = m.pair();
    const State lo = StoredStartMotion::remember(m.bodies[0].elements, m.step);
    const State hi = StoredStartMotion::remember(m.bodies[1].elements, m.step);
    const StoredStartMotion stored(pair, m.step, lo, hi);
    REQUIRE(stored.at_start());
    check_equal(*stored.at_start(), FullMotion(pair, m.step).at(m.step.begin));
    FinderResult result;
    first_separation(stored, pair, result);
    CHECK(result.evaluations == 0);
    pair.start = 0.0; // one of them has collided
    CHECK_FALSE(stored.at_start());
    check_equal(first_separation(stored, pair, result), FullMotion(pair, m.step).at(0.0));
    CHECK(result.evaluations == 1);
  });
}

TEST_CASE("cubics stay within the remainder of Hermite interpolation, fitted for the pair or kept for each particle") {
  for_all_meetings([](const Meeting& m) {
    const Pair pair = m.pair();
    CubicMotion fitted(pair, m.step);
    check_cubic(m, fitted);
    const Cubic lo = CachedCubicMotion::remember(m.bodies[0].elements, m.step);
    const Cubic hi = CachedCubicMotion::remember(m.bodies[1].elements, m.step);
    CachedCubicMotion cached(pair, m.step, lo, hi);
    check_cubic(m, cached);
  });
}

TEST_CASE("the late cubic is the full motion at the start, and the cubic once the search moves on") {
  for_all_meetings([](const Meeting& m) {
    const Pair pair = m.pair();
    LateCubicMotion late(pair, m.step);
    check_equal(late.at(pair.start), FullMotion(pair, m.step).at(pair.start));
    check_cubic(m, late);
    CHECK(late.at(0.0).d == CubicMotion(pair, m.step).at(0.0).d);
  });
}

} // namespace motions_test
