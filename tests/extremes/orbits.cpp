// Orbits without eccentricity, all at rest, any frequencies, denormal numbers and negative zeros.
#include "course.hpp"

#include "unit/collision/same_bits.hpp"
#include "unit/collision/spheres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keeler::extremes {
namespace {

using test::Ring;
using test::Sphere;

constexpr const char* orbit_section = "Orbits and numbers";
constexpr double denormal = std::numeric_limits<double>::denorm_min();

// On circles in one plane, in rows that the shear drives past each other.
Ring circles(double height, double eccentricity) {
  std::vector<Sphere> spheres;
  for (int k = 0; k < 60; ++k)
    spheres.push_back({{0.8 * (k - 30), 3.0 * (k * 7 % 13) - 18.0, 0.0}});
  Ring ring(test::patch_of(spheres, 50.0, 39.0), {}, two_pi * 1e-2);
  for (Body& b : ring.particles.bodies) {
    b.elements.e_cos = b.elements.e_sin = eccentricity;
    b.elements.i_sin = b.elements.i_cos = height;
  }
  return ring;
}

double largest_inclination(const Ring& ring) {
  double largest = 0.0;
  for (const Body& b : ring.particles.bodies)
    largest = std::max(largest, b.elements.inclination());
  return largest;
}

std::vector<Row> circular() {
  const State state{"e = i = 0", "60 circles in one plane, 30 steps of 1e-2 orbit"};
  Ring ring = circles(0.0, 0.0);
  std::vector<Row> rows = rows_of(state, against_plain(ring, {}, 30), 1e-13, 300);
  rows.push_back(exactly(state, "largest inclination", largest_inclination(ring), 0.0, "nothing pushes along z"));
  return rows;
}

// Many particles on one circle never meet, touching or not.
std::vector<Row> at_rest() {
  const State state{"all at rest",
                    "1000 spheres on one circle, every other one touching the next, 1e4 steps of 1e-2 orbit"};
  std::vector<Sphere> spheres;
  for (int k = 0; k < 1000; ++k)
    spheres.push_back({{0.0, 2.0 * k + 0.5 * test::quotient(k, 2) - 1250.0, 0.0}});
  Ring ring(test::patch_of(spheres, 100.0, 2600.0), {}, two_pi * 1e-2);
  ring.keeps_neighbours = true;
  const Particles before = ring.particles;
  while (ring.steps < 10'000)
    ring.advance();
  const bool same = test::same_bits(ring.particles, before);
  return {exactly(state, "contacts", static_cast<double>(ring.tally.fast + ring.tally.slow), 0.0, "nothing moves"),
          exactly(state, "states that differ in a bit from the start", same ? 0.0 : 1.0, 0.0, "nothing moves")};
}

std::vector<Row> frequencies() {
  const State state{"κ 0.5, 1, 1.9 with ν 0.5, 1, 4",
                    "60 spheres, τ 0.5, filling 0.15, seed 1, 60 steps of 5e-3 orbit for each of the nine"};
  AgainstPlain course;
  for (const double kappa : {0.5, 1.0, 1.9})
    for (const double nu : {0.5, 1.0, 4.0}) {
      test::Scenario s;
      s.kappa = kappa, s.nu = nu, s.step = two_pi * 5e-3;
      Ring ring(test::make_patch(s, 1), test::settings_of(s), s.step);
      course += against_plain(ring, test::settings_of(s), 60);
    }
  return rows_of(state, course, 1e-13, 500);
}

std::vector<Row> frequencies_of_runs() {
  std::vector<Row> rows;
  for (const auto& [kappa, nu] : {std::pair(0.5, 0.5), {0.5, 4.0}, {1.9, 1.0}, {1.9, 4.0}}) {
    const Example e = example(
        fmt::format("κ = {}, ν = {}", kappa, nu), "equilibrium",
        {fmt::format("planet.epicyclic_ratio={}", kappa), fmt::format("planet.vertical_ratio={}", nu), "time.end=2"});
    for (const Row& row : rows_of(e.state, follow(e.scene, 2000), 1e3))
      rows.push_back(row);
  }
  return rows;
}

// Zeros of either sign and the least numbers that there are must lead to the same states.
std::vector<Row> min_numbers() {
  std::vector<Row> rows;
  for (const auto& [name, value] : {std::pair("−0", -0.0), {"denormals", denormal}}) {
    const State state{name, "60 circles in one plane with all e and i that small, 30 steps of 1e-2 orbit"};
    Ring ring = circles(value, value), zero = circles(0.0, 0.0);
    const AgainstPlain course = against_plain(ring, {}, 30);
    against_plain(zero, {}, 30);
    double apart = 0.0;
    for (std::size_t k = 0; k < ring.particles.size(); ++k) {
      const Elements d = test::by_id(ring.particles)[k].elements - test::by_id(zero.particles)[k].elements;
      apart = std::max({apart, std::fabs(d.guiding_x), std::fabs(d.guiding_y), d.eccentricity()});
    }
    for (const Row& row : rows_of(state, course, 1e-13, 300))
      rows.push_back(row);
    rows.push_back(exactly(state, "largest difference from the same with +0", apart, 0.0, "they add nothing"));
    rows.push_back(at_most(state, "largest inclination", largest_inclination(ring), 1e-300, "nothing pushes along z"));
  }
  return rows;
}

} // namespace

std::vector<Subject> orbit_subjects() {
  using rows::Length;
  return {{"circles", orbit_section, Length::quick, circular},
          {"rest", orbit_section, Length::usual, at_rest},
          {"frequencies", orbit_section, Length::quick, frequencies},
          {"frequencies-runs", orbit_section, Length::usual, frequencies_of_runs},
          {"denormals", orbit_section, Length::quick, min_numbers}};
}

} // namespace keeler::extremes
