// A result depends on the scene and the state alone: equal bits after many steps for any number of threads, for
// neighbour lists kept or rebuilt at every step, and for any order of the particles in memory.
#include "draws.hpp"
#include "unit/collision/spheres.hpp"
#include "unit/collision/twin.hpp"

#include <keeler/collision/costs.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <span>

namespace any_way_test {

using namespace keeler;
using namespace keeler::collision;
using test::Ring;
using test::Scenario;

namespace {

struct Way {
  int threads = 1;
  bool keeps_neighbours = true;
  bool shuffled = false; // in memory
};

// Sanitizers watch the last two, after one thread that keeps its lists.
constexpr Way all_ways[] = {{1, false, false}, {2, true, false}, {3, true, true}, {8, true, false}, {3, false, true}};
constexpr std::span<const Way> ways = std::span(all_ways).subspan(test::sanitized ? 3 : 0);

// Moves particle k to index (stride · k) mod count: far from its neighbours.
template<class T> void shuffle(std::vector<T>& all) {
  const std::size_t stride = 7919; // a prime that divides no count here
  std::vector<T> moved(all.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    moved[stride * k % all.size()] = all[k];
  all = moved;
}

struct End {
  Particles particles;
  CollisionTally tally;
  std::uint64_t rolled_back = 0;
};

struct Walk {
  double step;
  int steps;
  double kicks = 0.0; // m rad⁻¹, after every other step
};

End run(const Patch& patch, const CollisionSettings& settings, const Walk& walk, const Way& way) {
  set_threads(way.threads);
  Ring ring(patch, settings, walk.step);
  ring.keeps_neighbours = way.keeps_neighbours;
  if (way.shuffled) {
    shuffle(ring.particles.bodies);
    shuffle(ring.particles.ids);
    if (ring.particles.rough)
      shuffle(ring.particles.spins);
  }
  for (int k = 0; k < walk.steps; ++k) {
    ring.advance();
    if (walk.kicks > 0.0 && k % 2 == 1)
      ring.kick_all(walk.kicks);
  }
  return {ring.particles, ring.tally, ring.drift.costs().rolled_back};
}

struct Seen {
  std::uint64_t collisions = 0, rolled_back = 0;
};

Seen same_any_way(const Patch& patch, const CollisionSettings& settings, const Walk& walk) {
  const int before = threads();
  const End first = run(patch, settings, walk, {});
  Seen seen{first.tally.fast + first.tally.slow, 0};
  for (const Way& way : ways) {
    const End other = run(patch, settings, walk, way);
    CAPTURE(way.threads);
    CAPTURE(way.keeps_neighbours);
    CAPTURE(way.shuffled);
    CHECK(test::same_bits(first.particles, other.particles));
    CHECK(test::same_bits(first.tally, other.tally));
    seen.rolled_back += other.rolled_back;
  }
  set_threads(before);
  return seen;
}

} // namespace

TEST_CASE("the same bits any way: uniform states, with and without kicks") {
  Scenario s;
  s.count = 4000;
  s.smallest = 0.4;
  s.step = two_pi * 2e-3;
  const Patch patch = test::make_patch(s, 1);
  CHECK(same_any_way(patch, {}, {s.step, test::sanitized ? 40 : 110}).collisions > (test::sanitized ? 1450 : 4000));
  CHECK(same_any_way(patch, {}, {s.step, test::sanitized ? 22 : 60, 0.2}).collisions > (test::sanitized ? 730 : 2000));
}

TEST_CASE("the same bits any way: dense states, where contacts follow from contacts") {
  Scenario s;
  s.count = 2500;
  s.filling = 0.4, s.optical_depth = 1.5;
  struct Case {
    double step, restitution; // orbits
    std::uint64_t steps;
  };
  for (const Case& c : {Case{1e-3, 0.0, 5}, Case{1e-3, 0.5, 25}, Case{1e-2, 0.0, 1}, Case{1e-2, 0.5, 15},
                        Case{1e-2, 1.0, 15}, Case{5e-2, 0.5, 4}, Case{5e-2, 1.0, 3}}) {
    CAPTURE(c.step);
    CAPTURE(c.restitution);
    s.step = two_pi * c.step;
    s.restitution = constant_restitution(c.restitution);
    const int steps = static_cast<int>(c.steps > 5 ? test::draws(c.steps) : c.steps);
    const Seen seen = same_any_way(test::make_patch(s, 2), test::settings_of(s), {s.step, steps});
    CHECK(seen.collisions > 1000);
    CHECK(seen.rolled_back > 0); // a contact of another domain preceded
  }
}

TEST_CASE("the same bits any way: dense states of rough spheres, whose spins are rolled back with their orbits") {
  Scenario s;
  s.count = 2500;
  s.filling = 0.4, s.optical_depth = 1.5;
  s.friction = {.tangential_restitution = 0.3, .coefficient = 0.5};
  for (const double step : {1e-3, 1e-2}) {
    s.step = two_pi * step;
    const Seen seen = same_any_way(test::make_patch(s, 2), test::settings_of(s), {s.step, 20});
    CHECK(seen.collisions > 1000);
    CHECK(seen.rolled_back > 0);
  }
}

TEST_CASE("the same bits any way: a moonlet, and particles that outrun the others") {
  Patch patch = test::patch_of(test::swarm(1000, 5e-3, 0.15, 0.3, 3), 5.0, 4.0);
  CHECK(same_any_way(patch, {}, {two_pi * 1e-3, 30}).collisions > 200);
  for (std::size_t k = 1; k < patch.size(); k += 200) {
    patch.velocities[k] *= 30.0;
    patch.masses[k] *= 1e3;
  }
  CHECK(same_any_way(patch, {}, {two_pi * 5e-4, 30}).collisions > 100);
}

TEST_CASE("the same bits any way: rows of touching spheres, each hit at its end at the same instant") {
  std::vector<test::Sphere> spheres;
  const int rows = test::sanitized ? 10 : 20;
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < 25; ++k)
      spheres.push_back(
          {{160.0 / rows * row - 80.0, 2.0 * k + (k > 0 ? 0.5 : 0.0) - 25.0, 0.0}, {0.0, k > 0 ? 0.0 : 30.0, 0.0}});
  for (const double restitution : {0.5, 1.0}) {
    CollisionSettings settings;
    settings.restitution = constant_restitution(restitution);
    CHECK(same_any_way(test::patch_of(spheres, 160.0, 70.0), settings, {two_pi * 5e-3, 3}).collisions >
          static_cast<std::uint64_t>(45 * rows / 2));
  }
}

namespace {

// Runs a dense ring in each way: threads, memory order, and a new Simulation from the state after so many steps.
// Masses are those of make_patch() times `heavier`.
void same_with_gravity(const std::string& resting_contacts, double heavier, int steps_of_restart) {
  Scenario s;
  s.count = 1000;
  s.smallest = 0.5;
  s.step = two_pi * 2e-3;
  Patch patch = test::make_patch(s, 4);
  for (double& mass : patch.masses)
    mass *= heavier;
  const Scene scene = parse_scene(fmt::format(R"(
[planet]
preset = "saturn-b-ring"
[box]
size = [{}, {}]
[particles]
count = 1000
density = 900.0
sizes = {{ law = "equal", radius = 1.0 }}
[gravity]
solver = "tree"
kick_every = 2
resting_contacts = "{}"
[time]
step = 2e-3
end = 1.0
)",
                                              patch.box.size_x, patch.box.size_y, resting_contacts),
                                  "test scene");
  constexpr int steps = 40;
  const int before = threads();
  set_threads(1);
  Simulation first(scene, patch);
  const simulation::SimulationState start = first.state();
  for (int k = 0; k < steps; ++k)
    first.advance();
  CHECK(first.state().collisions.fast > 500);
  CHECK((first.state().resting.pairs.size() > 30) == (resting_contacts == "carried"));
  for (const Way& way : ways) {
    set_threads(way.threads);
    simulation::SimulationState state = start;
    if (way.shuffled) {
      shuffle(state.particles.bodies);
      shuffle(state.particles.ids);
      for (simulation::ForceState& force : state.forces)
        shuffle(force.accelerations);
    }
    Simulation other(scene, state);
    for (int k = 0; k < steps; ++k) {
      if (!way.keeps_neighbours && k % steps_of_restart == 0)
        other = Simulation(scene, other.state());
      other.advance();
    }
    const simulation::SimulationState& end = other.state();
    CAPTURE(way.threads);
    CAPTURE(way.keeps_neighbours);
    CAPTURE(way.shuffled);
    CHECK(test::same_bits(first.state().particles, end.particles));
    CHECK(test::same_bits(first.state().collisions, end.collisions));
    CHECK(end.resting.pairs == first.state().resting.pairs);
    CHECK(end.resting.work == first.state().resting.work);
  }
  set_threads(before);
}

} // namespace

TEST_CASE("the same bits any way: a run with self-gravity, restarted at each step") {
  same_with_gravity("bounced", 2.0, 1);
}

// Between kicks a state does not have the pairs that touched slowly since the last one: runs stop at kicks.
TEST_CASE("the same bits any way: a run with contacts at rest, restarted at each kick") {
  same_with_gravity("carried", 8.0, 2);
}

} // namespace any_way_test
