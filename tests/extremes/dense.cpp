// Optical depths from almost nothing to 5, filling 0.6, jammed rows, restitution 0 and 1.
#include "course.hpp"

#include "unit/collision/spheres.hpp"

#include <keeler/cells/overlap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::extremes {
namespace {

using test::Ring;
using test::Sphere;

constexpr const char* density_section = "Density and restitution";

std::vector<Row> depths() {
  struct Case {
    double depth, dispersion;
    int count, orbits;
    double least; // contacts
  };
  std::vector<Row> rows;
  for (const Case& c : {Case{1e-4, 2.0, 2000, 50, 20},
                        {1e-2, 2.0, 2000, 10, 500},
                        {1.0, 2.0, 2000, 2, 1e4},
                        {5.0, 5.0, 2000, 2, 1e4}}) {
    const double side = std::sqrt(pi * c.count / c.depth);
    const Example e = example(fmt::format("τ = {}", c.depth), "equilibrium",
                              {fmt::format("particles.optical_depth={}", c.depth),
                               fmt::format("particles.velocity_dispersion={}", c.dispersion),
                               fmt::format("box.size=[{0:.2f},{0:.2f}]", side), fmt::format("time.end={}", c.orbits)});
    for (const Row& row : rows_of(e.state, follow(e.scene, 1000L * c.orbits), c.least))
      rows.push_back(row);
  }
  return rows;
}

// A run of spheres of radius 1 placed by hand, by the way of a run.
Course follow_spheres(const std::vector<Sphere>& spheres, double size_x, double size_y, double step, int steps) {
  const Scene scene = example("", "equilibrium", {fmt::format("time.step={}", step)}).scene;
  Patch patch = test::patch_of(spheres, size_x, size_y);
  patch.orbital_frequency = scene.planet.orbital_frequency;
  Simulation simulation(scene, patch);
  return follow(simulation, steps, steps);
}

Row no_storm(const State& state, const Course& course) {
  return at_most(state, "contacts of a particle in the worst step", course.worst_step, 1e4,
                 "a tenth of what ends a run as a storm");
}

// Face-centred cubic, periodic in the plane, and eight layers high.
std::vector<Row> lattice() {
  const State state{
      "a lattice at filling 0.6",
      "2304 spheres in a table of places, speeds of 3 radii Ω at random (seed 1), 300 steps of 1e-3 orbit"};
  constexpr int cells = 12;
  const double side = std::cbrt(4.0 * (4.0 / 3.0 * pi) / 0.6); // of a cell of four spheres of radius 1
  test::RandomVectors random(1);
  std::vector<Sphere> spheres;
  for (int k = 0; k < cells * cells * 4 * 4; ++k) {
    const Vec3 corner(test::quotient(k, 4) % cells - 0.5 * cells, test::quotient(k, 4 * cells) % cells - 0.5 * cells,
                      test::quotient(k, 4 * cells * cells) - 2.0);
    const Vec3 faces[] = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
    spheres.push_back({side * (corner + faces[k % 4]), 3.0 * random.direction()});
  }
  const Course course = follow_spheres(spheres, cells * side, cells * side, 1e-3, 300);
  std::vector<Row> rows = rows_of(state, course, 1e4);
  rows.push_back(no_storm(state, course));
  return rows;
}

// Rows that nest in each other, closed through the edge of the box, with 1e-6 of a radius to each contact; hit from
// above. The shear moves whole rows.
std::vector<Row> jammed() {
  const State state{"jammed rows",
                    "9 rows of 100 spheres in a table of places, hit by 20 from above, 300 steps of 1e-3 orbit"};
  const double spacing = 2.0 + 1e-6;
  std::vector<Sphere> spheres;
  for (int k = 0; k < 900; ++k)
    spheres.push_back({{std::sqrt(0.75) * spacing * (test::quotient(k, 100) - 4),
                        spacing * (k % 100 - 50 + 0.5 * (test::quotient(k, 100) % 2)), 0.0}});
  for (int k = 0; k < 20; ++k)
    spheres.push_back({{0.1, 10.0 * k - 95.0, 3.0}, {0.1, 0.0, -10.0}});
  const Course course = follow_spheres(spheres, 20.0, 100 * spacing, 1e-3, 300);
  std::vector<Row> rows = rows_of(state, course, 1000);
  rows.push_back(no_storm(state, course));
  return rows;
}

double epicyclic(const Ring& ring) {
  double sum = 0.0;
  for (const Body& b : ring.particles.bodies)
    sum += b.mass * epicyclic_energy(b.elements, ring.frequencies);
  return sum;
}

// κ = 2 has no shear, so elastic spheres have nothing but their own energy. Others live from the shear of κ = 1, and
// their budget must close.
std::vector<Row> restitution(double value) {
  const bool elastic = value == 1.0;
  const State state{fmt::format("ε = {}", value),
                    fmt::format("40 spheres in a box of 10 x 10 radii, κ = {}, steps of 1e-2 orbit, until each has "
                                "collided 1e4 times",
                                elastic ? 2 : 1)};
  collision::CollisionSettings settings;
  settings.restitution = collision::constant_restitution(value);
  test::RandomVectors random(7);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 40; ++k)
    spheres.push_back({{2.4 * (k % 4) - 3.6, 2.4 * (test::quotient(k, 4) % 4) - 3.6, 2.4 * test::quotient(k, 16) - 2.4},
                       3.0 * random.direction()});
  Ring ring(test::patch_of(spheres, 10.0, 10.0, {elastic ? 2.0 : 1.0, 1.0}), settings, two_pi * 1e-2);
  ring.keeps_neighbours = true;
  const double start = epicyclic(ring);
  double largest = start, overlap = 0.0;
  std::uint64_t contacts = 0;
  while (contacts < 40 * 10'000 / 2 && ring.steps < 10'000'000) {
    ring.advance();
    contacts = ring.tally.fast + ring.tally.slow;
    largest = std::max(largest, epicyclic(ring));
    if (ring.steps % 1000 == 0)
      overlap = std::max(overlap, cells::largest_overlap(ring.patch()).depth);
  }
  const double open = epicyclic(ring) - start - epicyclic_gain(ring.tally, ring.frequencies);
  return {at_least(state, "contacts of a particle", 2.0 * static_cast<double>(contacts) / 40.0, 1e4,
                   "so many that roundings of one sign would show"),
          at_most(state, "energy that the budget leaves open, over the energy", std::fabs(open) / largest, 2e-12,
                  "2e-16 for each contact of a particle: a rounding each, of one sign where all radii are 1 m"),
          at_most(state, "deepest overlap over the radius sum", overlap, 1e-13, "rounding of places")};
}

} // namespace

std::vector<Subject> dense_subjects() {
  using rows::Length;
  return {{"depths", density_section, Length::usual, depths},
          {"lattice", density_section, Length::usual, lattice},
          {"jammed", density_section, Length::usual, jammed},
          {"elastic", density_section, Length::usual, [] { return restitution(1.0); }},
          {"inelastic", density_section, Length::usual, [] { return restitution(0.0); }}};
}

} // namespace keeler::extremes
