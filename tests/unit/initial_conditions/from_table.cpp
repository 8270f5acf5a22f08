#include <keeler/initial_conditions/from_table.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

namespace from_table_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

constexpr double omega = 2e-4;

scene::TableScene table_scene() {
  scene::TableScene of;
  of.scene.planet.orbital_frequency = omega;
  of.scene.size_x = 60.0;
  of.scene.size_y = 40.0;
  return of;
}

io::ParticleTable one(const Vec3& place, const Vec3& velocity) {
  return {"t.csv", {place}, {velocity}, {1.0}, {4000.0}, {2}};
}

std::string fault(const io::ParticleTable& table) {
  try {
    patch_from_table(table, table_scene());
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

// Spheres of 0.5 to 1.5 m at random in a slab, their mid-plane filled to a third and many of them overlapping.
Patch crowd() {
  io::ParticleTable table;
  RandomStream random(3, RandomPurpose::position, 0);
  for (int k = 0; k < 700; ++k) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform(), r = random.uniform();
    table.positions.emplace_back(60.0 * (x - 0.5), 40.0 * (y - 0.5), 4.0 * (z - 0.5));
    table.radii.push_back(0.5 + r);
  }
  scene::TableScene of = table_scene();
  of.density = 900.0;
  return patch_from_table(table, of);
}

} // namespace

TEST_CASE("a table's particles are taken as they are") {
  io::ParticleTable table = one({10.0, -5.0, 1.0}, {1e-4, -3e-3, 2e-4});
  const Patch patch = patch_from_table(table, table_scene());
  CHECK(patch.positions == table.positions);
  CHECK((patch.velocities[0] * omega - table.velocities[0]).norm() < 1e-18);
  CHECK(patch.masses == table.masses);
  CHECK(patch.ids == std::vector<std::uint64_t>{0});
  CHECK(patch.offset == 0.0);
  CHECK(patch.box.size_y == 40.0);

  table.velocities.clear(); // circular: S x in the orbit's direction, backwards
  table.masses.clear();
  scene::TableScene of = table_scene();
  CHECK_THROWS_WITH_AS(
      patch_from_table(table, of),
      "t.csv: no column m, and the scene has no particles.density (one of them is needed for the masses); add "
      "either",
      UsageError);
  of.density = 900.0;
  const Patch circular = patch_from_table(table, of);
  CHECK(circular.velocities[0] == Vec3(0.0, -15.0, 0.0));
  CHECK(circular.masses[0] == doctest::Approx(900.0 * 4.0 / 3.0 * pi).epsilon(1e-15));
}

TEST_CASE("a table's spins are those of rough particles, in rad/s against the stars; smooth ones have none") {
  io::ParticleTable table = one({10.0, -5.0, 1.0}, {1e-4, -3e-3, 2e-4});
  table.spins = {{1e-4, -2e-4, 3e-4}};
  scene::TableScene of = table_scene();
  CHECK_THROWS_WITH_AS(patch_from_table(table, of),
                       "t.csv: sx sy sz are spins, but the scene's particles are smooth (it has no "
                       "[collisions.friction]); add that table to the scene or remove the columns",
                       UsageError);
  of.scene.collisions.friction = collision::Friction{};
  const Patch patch = patch_from_table(table, of);
  REQUIRE(patch.spins.size() == 1);
  CHECK((patch.spins[0] - Vec3(0.5, -1.0, 1.5)).norm() < 1e-15);
  table.spins[0].y() = NAN;
  CHECK_THROWS_WITH_AS(patch_from_table(table, of),
                       "t.csv:2: the particle has a spin that is not finite; correct it or remove the row", UsageError);
  table.spins[0].y() = 2000.0;
  CHECK_THROWS_AS(patch_from_table(table, of), UsageError);
  table.spins.clear();
  CHECK(patch_from_table(table, of).spins.empty()); // they begin at 0
}

TEST_CASE("a particle that no ring has, or outside the box, is named by its row") {
  const Vec3 here(1.0, 1.0, 0.0), still(0.0, -1.5 * omega, 0.0);
  CHECK(fault(one(here, still)).empty());
  const auto says = [&](const io::ParticleTable& table, const std::string& words) {
    CAPTURE(fault(table));
    CHECK(fault(table).find("t.csv:2: the particle has " + words) == 0);
    CHECK(fault(table).find("; correct it or remove the row") != std::string::npos);
  };
  says(one({1.0, NAN, 0.0}, still), "a position or a velocity that is not finite");
  says(one(here, {0.0, INFINITY, 0.0}), "a position or a velocity that is not finite");
  io::ParticleTable table = one(here, still);
  table.radii[0] = -1.0;
  says(table, "a radius (m) of -1 (possible is from 1e-6 to 1000000)");
  table = one(here, still);
  table.masses[0] = -4000.0;
  says(table, "a density (kg/m^3, by its mass and radius) of -955");
  says(one(here, {0.0, 2000.0, 0.0}), "a speed (m/s, beyond the shear) of 2000");
  says(one({40.0, 1.0, 0.0}, {0.0, -60.0 * omega, 0.0}), "x = 40, y = 1 outside the box of 60 m x 40 m about 0");
  CHECK(fault(one({40.0, 1.0, 0.0}, {0.0, -80.0 * omega, 0.0})).empty()); // X = 2 (v_y/Ω + 2 x) = 0: eccentric
  CHECK(fault(one({31.0, 1.0, 0.0}, {0.0, -46.5 * omega, 0.0})).empty()); // as far out as in snapshots
}

TEST_CASE("particles that overlap are counted, and moved apart with their random velocities") {
  Patch patch = crowd();
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < patch.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (int nx = -1; nx <= 1; ++nx)
        for (int ny = -1; ny <= 1; ++ny) {
          const Vec3 d = patch.positions[i] + patch.box.displacement({nx, ny}, 0.0) - patch.positions[j];
          const double sum = patch.radii[i] + patch.radii[j];
          pairs += (sum - d.norm()) / sum > 1e-8;
        }
  REQUIRE(pairs > 100);
  CHECK(cells::count_overlaps(patch, 1e-8) == pairs);
  const Patch before = patch;
  const Relaxation done = relax(patch);
  CHECK(cells::count_overlaps(patch, 0.0) == 0);
  CHECK(done.moved > pairs / 2);
  CHECK(done.farthest < 5.0);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3 shift = patch.positions[k] - before.positions[k];
    CHECK((patch.velocities[k] - before.velocities[k] + Vec3(0.0, 1.5 * shift.x(), 0.0)).norm() < 1e-12);
  }
  Patch apart = patch;
  CHECK(relax(apart).farthest == 0.0);
}

TEST_CASE("a message about overlaps says what may be wrong with the table") {
  const auto patch_of = [](std::vector<Vec3> positions) {
    io::ParticleTable table;
    table.positions = std::move(positions);
    table.radii.assign(table.positions.size(), 1.0);
    scene::TableScene of = table_scene();
    of.density = 900.0;
    return patch_from_table(table, of);
  };
  CHECK(overlap_hint(patch_of({{0.0, 0.0, 0.0}, {1.5, 0.0, 0.0}, {20.0, 10.0, 0.0}})).empty());
  const std::string across = overlap_hint(patch_of({{-29.9, 5.0, 0.0}, {29.9, 5.0, 0.0}, {0.0, -15.0, 0.0}}));
  CHECK(across.find("; that pair meets across an edge of the box: is the shear offset right") == 0);
  const std::string small = overlap_hint(patch_of({{-0.03, 0.0, 0.0}, {0.02, 0.01, 0.0}, {0.01, -0.02, 0.0}}));
  CHECK(small.find("; all are within 0.05 m x 0.03 m of a box of 60 m x 40 m") == 0);
  std::vector<Vec3> heap; // so many that the table is refused at once
  for (int k = 0; k < 10000; ++k)
    heap.emplace_back(1e-6 * k, 0.0, 0.0);
  CHECK_THROWS_WITH_AS(patch_of(heap), doctest::Contains("are these in km?"), InvariantError);
}

} // namespace from_table_test
