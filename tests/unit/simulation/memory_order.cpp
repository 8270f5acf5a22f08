// Memory order affects speed only: after a permutation of the particles in memory a state evolves identically, bit for
// bit, with all energy accounts of kicks and collisions.
#include <keeler/core/field_table.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace memory_order_test {

using namespace keeler;
using namespace keeler::simulation;

namespace {

using Order = std::vector<std::uint32_t>;
using Shuffle = std::function<void(Order&)>;

// Returns the rows of a field with one row per particle.
void reorder_rows(const Field& field, const Order& order) {
  const std::size_t width = field.components * size_of(field.type);
  const auto* const from = static_cast<const std::byte*>(field.data());
  const std::vector<std::byte> before(from, from + field.bytes());
  auto* const to = static_cast<std::byte*>(field.data());
  for (std::size_t k = 0; k < order.size(); ++k)
    std::memcpy(to + k * width, before.data() + order[k] * width, width);
}

void put_in_order(SimulationState& state, const Order& order) {
  const FieldTable table = state.fields();
  for (const Field& field : table.fields())
    if (field.rows() == order.size()) // one row for each particle
      reorder_rows(field, order);
}

Order pluralize(std::size_t count) {
  Order order(count);
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

// Returns all values of a checkpoint, sorted by id.
std::vector<std::string> content(SimulationState state) {
  Order order = pluralize(state.particles.size());
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return state.particles.ids[a] < state.particles.ids[b]; });
  put_in_order(state, order);
  std::vector<std::string> fields;
  const FieldTable table = state.fields();
  for (const Field& field : table.fields())
    fields.push_back(field.name + ": " + std::string(static_cast<const char*>(field.data()), field.bytes()));
  return fields;
}

// Names the first field that differs.
std::string difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] != b[k])
      return a[k].substr(0, a[k].find(':'));
  return "";
}

Scene dense_scene(const std::string& more, const std::string& step = "2e-3") {
  return parse_scene(
      "planet.preset = \"saturn-a-ring\"\nbox.size = [40.0, 60.0]\n"
      "particles = { count = 600, density = 600.0, sizes = { law = \"power\", exponent = 3.0, min = 0.5, "
      "max = 1.5 } }\n"
      "time = { step = " +
          step + ", end = 10.0 }\n" + more,
      "test scene");
}

void check_any_order(const Scene& scene, int steps_after) {
  Simulation beginning(scene, initial_patch(scene));
  for (int k = 0; k < 3; ++k) // beyond the step that sorts the particles
    beginning.advance();
  const SimulationState start = beginning.state();
  const auto after = [&](const Shuffle& shuffle) {
    SimulationState state = start;
    Order order = pluralize(state.particles.size());
    shuffle(order);
    put_in_order(state, order);
    Simulation simulation(scene, state);
    for (int k = 0; k < steps_after; ++k)
      simulation.advance();
    CHECK(simulation.state().collisions.fast > start.collisions.fast);
    return content(simulation.state());
  };
  std::mt19937_64 random(4);
  const std::vector<std::string> usual = after([](Order&) {});
  CHECK(difference(usual, after([](Order& order) { std::reverse(order.begin(), order.end()); })) == "");
  for (int trial = 0; trial < 3; ++trial)
    CHECK(difference(usual, after([&](Order& order) { std::shuffle(order.begin(), order.end(), random); })) == "");
}

} // namespace

TEST_CASE("no bit of a state depends on the order of particles in memory") {
  const std::string spins = "collisions.friction = { tangential_restitution = 0.5 }\n";
  for (const std::string& more :
       {std::string("gravity.solver = \"fft\"\n") + spins,
        std::string("gravity = { solver = \"tree\", resting_contacts = \"carried\" }\n"),
        std::string("gravity.solver = \"direct\"\n"), std::string("gravity.solver = \"mesh\"\n"),
        std::string("gravity = { solver = \"axisymmetric\", shortest_wavelength = 10.0 }\nconstant_acceleration.radial "
                    "= 1e-9\n"),
        std::string()}) {
    CAPTURE(more);
    check_any_order(dense_scene(more), 10);
  }
  check_any_order(dense_scene("gravity.solver = \"fft\"\n", "\"auto\""), 10);
}

TEST_CASE("nor does one after the next ordering by place") {
  check_any_order(dense_scene("gravity.solver = \"fft\"\n"), 60); // sorted every 50 steps
}

} // namespace memory_order_test
