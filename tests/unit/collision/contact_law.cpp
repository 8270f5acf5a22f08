// The law of contacts between kicks, case by case, and its limits.
#include "contact_law.hpp"

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace contact_law_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

constexpr double omega = 1e-4;
const TouchingPair pair{0, 1, 1.0, 0.5};

CollisionSettings settings(double restitution, double cut) {
  CollisionSettings all;
  all.restitution = constant_restitution(restitution);
  all.elastic_below = cut;
  return all;
}

} // namespace

TEST_CASE(
    "a contact without gravity, in the middle of the interval, or of a particle at rest has the drift's velocity") {
  const CollisionSettings with = settings(0.5, 1e-3);
  const Vec3 v(-1.0, 0.3, -0.2), n(1.0, 0.0, 0.0);
  const std::vector<Vec3> accelerations = {Vec3(0.4, 0.0, 0.0), Vec3(-0.6, 0.0, 0.0)};
  const std::vector<std::uint8_t> rests = {0, 1};
  const auto has_drift_velocity = [&](const KickInterval& gravity, double time) {
    const ContactLaw law = contact_law(with, gravity, omega, pair, v, n, time);
    return law.velocity == v && law.approach == 1.0 && law.rebound.speed == 0.5 && law.lag.norm() == 0.0 && law.acts();
  };
  CHECK(has_drift_velocity({}, 0.2));
  CHECK(has_drift_velocity({.accelerations = accelerations, .middle = 0.2}, 0.2));
  CHECK(has_drift_velocity({.accelerations = accelerations, .middle = 0.1, .at_rest = rests}, 0.2));
  CHECK_FALSE(has_drift_velocity({.accelerations = accelerations, .middle = 0.1}, 0.2));
}

TEST_CASE("a resolved contact rebounds in the true velocity; others in the drift's; all separate in the drift") {
  RandomStream random(1, RandomPurpose::sample, 0);
  const auto some = [&] { return 2.0 * random.uniform() - 1.0; };
  int resolved = 0, receding = 0, returning = 0;
  for (int k = 0; k < 4000; ++k) {
    const double restitution = random.uniform();
    const CollisionSettings with = settings(restitution, k % 2 ? 1e-3 : 0.2);
    const Vec3 n = Vec3(some(), some(), some()).normalized();
    Vec3 v(some(), some(), some());
    if (v.dot(n) > 0.0)
      v = -v; // the finder has found that the pair approaches in the drift
    const std::vector<Vec3> accelerations = {Vec3(some(), some(), some()), Vec3(some(), some(), some())};
    const double middle = some(), time = some();
    const ContactLaw law =
        contact_law(with, {.accelerations = accelerations, .middle = middle}, omega, pair, v, n, time);
    const Vec3 g = accelerations[1] - accelerations[0], u = v + (time - middle) * g;
    CHECK((law.lag - (u - v)).norm() < 1e-14);
    REQUIRE(law.acts());
    const Vec3 after = v + (law.approach + law.rebound.speed) * n; // by the impulse, in the drift
    CHECK(after.dot(n) > 0.5 * with.min_rebound(1.5));
    const double cut = with.cut_speed(1.5);
    const double kept = law.approach >= cut ? restitution : 1.0;
    CHECK(law.rebound.speed == doctest::Approx(std::max(kept * law.approach, 1e-3 * cut)));
    if (law.resolved) {
      ++resolved;
      CHECK(law.approach == doctest::Approx(-u.dot(n)));
      CHECK((after + law.lag).dot(n) == doctest::Approx(law.rebound.speed)); // the true velocity
    } else {
      CHECK(law.approach == doctest::Approx(-v.dot(n)));
      ++(u.dot(n) >= 0.0 ? receding : returning);
    }
  }
  CHECK(resolved > 1000);
  CHECK(receding > 100);
  CHECK(returning > 100);
}

} // namespace contact_law_test
