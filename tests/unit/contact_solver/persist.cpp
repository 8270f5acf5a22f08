// Two clusters of contacts at rest, held in one call, against each of them held by itself.
#include <keeler/contact_solver/resting_contacts.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

namespace persist_test {

using namespace keeler;
using namespace keeler::contact_solver;

namespace {

constexpr double gravity = 10.0; // m³ kg⁻¹ rad⁻²
constexpr double interval = 0.03;
constexpr Frequencies frequencies{1.0, 1.0};

struct Sphere {
  std::uint64_t id;
  Vec3 position;     // m
  Vec3 acceleration; // m rad⁻²
};

// A chain of three spheres, one above the other; the outer ones are pulled to the middle one.
std::vector<Sphere> chain() {
  return {{3, {0.0, 0.0, -2.001}, {0.0, 0.0, 6.0}}, {8, Vec3::Zero(), Vec3::Zero()}, {5, {0, 0, 2.001}, {0, 0, -7.0}}};
}

// Two spheres that follow each other along the orbit, far from the chain.
std::vector<Sphere> follower() {
  return {{2, {20.0, 10.0, 0.0}, {0.0, 5.0, 0.0}}, {6, {20.0, 12.002, 0.0}, {0.0, -5.0, 0.0}}};
}

struct Held {
  Particles particles;
  RestingState state;
};

// Holds neighbours in the list, which come to rest, until the next kick; or only kicks them. They start with the half
// kick that ends an interval, on circular orbits before it.
Held hold(const std::vector<std::vector<Sphere>>& clusters, bool with_impulses = true) {
  Held held;
  std::vector<Vec3> accelerations;
  std::vector<collision::SlowPair> pairs;
  for (const std::vector<Sphere>& cluster : clusters)
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      const Sphere& s = cluster[k];
      const Vec3 velocity = Vec3(0.0, -frequencies.shear() * s.position.x(), 0.0) + 0.5 * interval * s.acceleration;
      const auto index = static_cast<std::uint32_t>(held.particles.size());
      held.particles.bodies.push_back(
          {elements_from({s.position, velocity}, frequencies, Rotation(frequencies, 0.0)), 1.0, 1.0});
      held.particles.ids.push_back(s.id);
      accelerations.push_back(s.acceleration);
      if (k > 0 && cluster[k - 1].id < s.id)
        pairs.push_back({index - 1, index, 1.0});
      else if (k > 0)
        pairs.push_back({index, index - 1, 1.0});
    }
  double work = 0.0, azimuthal = 0.0;
  const std::array<KickPart, 1> kicks = {{{accelerations, 0.5 * interval, 0.5 * interval, &work, &azimuthal}}};
  const RestingStep step{
      held.particles, frequencies, ShearingBox{100.0, 100.0, frequencies.shear()}, 0.0, 0.0, interval, gravity, kicks};
  collision::CollisionTally tally;
  RestingContacts resting;
  for (const collision::SlowPair& pair : pairs)
    if (with_impulses)
      resting.note(held.particles, pair);
  resting.persist(held.state, step, std::nullopt, tally);
  for (std::size_t k = 0; k < held.particles.size(); ++k)
    kick(held.particles.bodies[k].elements, 0.5 * interval * accelerations[k], frequencies, Rotation(frequencies, 0.0));
  std::vector<std::uint8_t> at_rest(held.particles.size());
  resting.persist_second_half(held.state, step, tally, at_rest);
  return held;
}

const Body& body(const Held& held, std::uint64_t id) {
  const auto found = std::find(held.particles.ids.begin(), held.particles.ids.end(), id);
  REQUIRE(found != held.particles.ids.end());
  return held.particles.bodies[static_cast<std::size_t>(found - held.particles.ids.begin())];
}

bool same_bits(const Body& a, const Body& b) {
  return std::memcmp(&a, &b, sizeof(Body)) == 0;
}

double impulse(const Held& held, const RestingPair& pair) {
  const auto found = std::find(held.state.pairs.begin(), held.state.pairs.end(), pair);
  REQUIRE(found != held.state.pairs.end());
  return held.state.loads[static_cast<std::size_t>(found - held.state.pairs.begin())].impulse;
}

} // namespace

TEST_CASE("a cluster moves beside another as by itself, to the last bit") {
  const Held both = hold({follower(), chain()}), other_order = hold({chain(), follower()});
  CHECK(both.state.pairs == std::vector<RestingPair>{{2, 6}, {3, 8}, {5, 8}});
  for (const Held& alone : {hold({chain()}), hold({follower()})}) {
    CHECK(!alone.state.pairs.empty());
    for (const RestingPair& pair : alone.state.pairs) {
      CHECK(impulse(alone, pair) > 0.0);
      CHECK(impulse(both, pair) == impulse(alone, pair));
      CHECK(impulse(other_order, pair) == impulse(alone, pair));
    }
    for (const std::uint64_t id : alone.particles.ids) {
      CHECK(same_bits(body(both, id), body(alone, id)));
      CHECK(same_bits(body(other_order, id), body(alone, id)));
    }
  }
}

TEST_CASE("spheres at rest have a small gap at the next kick, where they would overlap without impulses") {
  const Held held = hold({chain(), follower()}), free = hold({chain(), follower()}, false);
  const Rotation then(frequencies, interval);
  const auto distance = [&](const Held& which, const RestingPair& pair) {
    const Elements relative = body(which, pair.high).elements - body(which, pair.low).elements;
    return state_at(relative, frequencies, then).position.norm();
  };
  CHECK(held.state.pairs.size() == 3);
  for (const RestingPair& pair : held.state.pairs) {
    CHECK(distance(held, pair) > 2.0);
    CHECK(distance(held, pair) < 2.003);
    CHECK(distance(free, pair) < 2.0);
  }
}

} // namespace persist_test
