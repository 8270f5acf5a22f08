// Two bodies in Hill's frame: grains past a moonlet, a bound pair, and pairs that fall on each other.
#include "rows.hpp"

#include "physics/rebounds.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::validation {
namespace {

constexpr double a_ring_omega = 1.3175e-4; // rad/s

struct Motion {
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero(); // of one body from the other, m and m per 1/Ω
};

// κ = ν = Ω, and the attraction of both masses, G(M + m)/Ω² in m³.
Motion hill_equations(const Motion& m, double attraction) {
  const Vec3 pull = -attraction / std::pow(m.place.norm(), 3.0) * m.place;
  return {
      m.velocity,
      {2.0 * m.velocity.y() + 3.0 * m.place.x() + pull.x(), -2.0 * m.velocity.x() + pull.y(), -m.place.z() + pull.z()}};
}

Motion moved(const Motion& m, const Motion& rate, double time) {
  return {m.place + time * rate.place, m.velocity + time * rate.velocity};
}

// The fourth-order Runge-Kutta method in steps of 1e-4 orbits, which err by 1e-10 of r_H at most; the least distance.
Motion integrated(Motion m, double attraction, double orbits, double& closest) {
  const auto steps = static_cast<int>(std::lround(orbits * 1e4));
  const double h = two_pi * 1e-4;
  closest = m.place.norm();
  for (int k = 0; k < steps; ++k) {
    const Motion a = hill_equations(m, attraction), b = hill_equations(moved(m, a, h / 2), attraction),
                 c = hill_equations(moved(m, b, h / 2), attraction), d = hill_equations(moved(m, c, h), attraction);
    m.place += h / 6.0 * (a.place + 2.0 * b.place + 2.0 * c.place + d.place);
    m.velocity += h / 6.0 * (a.velocity + 2.0 * b.velocity + 2.0 * c.velocity + d.velocity);
    closest = std::min(closest, m.place.norm());
  }
  return m;
}

Scene without_images(double side, std::size_t count, double step) {
  return parse_scene(fmt::format(R"(
planet.orbital_frequency = {}
box.size = [{}, {}]
particles = {{ count = {}, density = 900, sizes = {{ law = "equal", radius = 1.0 }} }}
gravity = {{ solver = "direct", images = "rings", image_rings = 0, kick_every = 1 }}
time = {{ step = {}, end = 1000.0 }}
)",
                                 a_ring_omega, side, side, count, step),
                     "two bodies");
}

double mass_of(double radius, double density) {
  return 4.0 / 3.0 * pi * density * radius * radius * radius;
}

void add(Patch& patch, const Motion& motion, double radius, double mass) {
  patch.positions.push_back(motion.place);
  patch.velocities.push_back(motion.velocity);
  patch.radii.push_back(radius);
  patch.masses.push_back(mass);
  patch.ids.push_back(patch.ids.size());
}

Patch patch_for(double side) {
  Patch patch;
  patch.box = {side, side, 1.5, 0.0};
  patch.orbital_frequency = a_ring_omega;
  return patch;
}

// Grains on circular orbits that pass a moonlet of 10 m during two orbits without touching it: the median of how far
// from the exact places they end, in Hill radii.
double passing_error(double step) {
  constexpr double radius = 10.0, grain = 1e-3, orbits = 2.0;
  const double attraction = newton_g(a_ring_omega) * mass_of(radius, 900.0), hill = std::cbrt(attraction / 3.0);
  const double width = 100.0 * hill;
  const Scene scene = without_images(width, 61, step);
  Patch patch = patch_for(width);
  add(patch, {}, radius, mass_of(radius, 900.0));
  std::vector<Vec3> ends;
  RandomStream random(1, RandomPurpose::position, 0);
  while (ends.size() < 60) {
    const double side = random.uniform() < 0.5 ? 1.0 : -1.0, x = side * hill * (1.0 + 2.5 * random.uniform());
    Motion start;
    start.place = {x, 0.75 * x * two_pi * orbits, hill * (random.uniform() - 0.5)}; // half way it is beside the moonlet
    start.velocity = {0.0, -1.5 * x, 0.0};
    double closest = 0.0;
    const Motion end = integrated(start, attraction, orbits, closest);
    if (closest < 1.05 * radius)
      continue;
    ends.push_back(end.place);
    add(patch, start, grain, 1e-12 * mass_of(radius, 900.0));
  }
  Simulation simulation(scene, patch);
  while (simulation.orbits() < orbits - 0.5 * step)
    simulation.advance();
  const Patch end = simulation.patch();
  std::vector<double> errors;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const Vec3 away = end.positions[k + 1] - end.positions[0] - ends[k];
    errors.push_back(away.norm() / hill);
  }
  std::nth_element(errors.begin(), errors.begin() + 30, errors.end());
  return errors[30];
}

double jacobi(const Patch& patch, double attraction) {
  const Vec3 place = patch.positions[1] - patch.positions[0], velocity = patch.velocities[1] - patch.velocities[0];
  return 0.5 * (velocity.squaredNorm() - 3.0 * place.x() * place.x() + place.z() * place.z()) -
         attraction / place.norm();
}

struct Pair {
  double nearest = 1.05, farthest = 1.05; // distances; contact is 1
  double largest_change = 0.0;            // of the Jacobi energy, over G(M + m)/(R + r)
};

// Two spheres of 1 m that circle each other against the orbit for 100 orbits.
Pair bound_pair(double step) {
  constexpr double side = 100.0;
  const Scene scene = without_images(side, 2, step);
  Patch patch = patch_for(side);
  const double attraction = 2.0 * newton_g(a_ring_omega) * mass_of(1.0, 1800.0);
  Motion half;
  half.place = {1.05, 0.0, 0.0};
  half.velocity = {0.0, -3.75 * half.place.x(), 0.0};
  add(patch, half, 1.0, mass_of(1.0, 1800.0));
  add(patch, {-half.place, -half.velocity}, 1.0, mass_of(1.0, 1800.0));
  Simulation simulation(scene, patch);
  const double start = jacobi(patch, attraction);
  Pair pair;
  while (simulation.orbits() < 100.0) {
    simulation.advance();
    const Patch now = simulation.patch();
    const double distance = (now.positions[1] - now.positions[0]).norm() / 2.0;
    pair.nearest = std::min(pair.nearest, distance);
    pair.farthest = std::max(pair.farthest, distance);
    pair.largest_change =
        std::max(pair.largest_change, std::fabs(jacobi(now, attraction) - start) / (attraction / 2.0));
  }
  return pair;
}

// Measured at three steps; the error falls as the square of the step.
std::vector<Row> encounters() {
  std::vector<Row> rows;
  for (const auto& [step, bound] : {std::pair(1e-3, 1.5e-5), {5e-3, 3.8e-4}})
    rows.push_back({.what = fmt::format("grains past a moonlet: median error of the place, r_H, step {}", step),
                    .measured = passing_error(step),
                    .expected = 0.0,
                    .tolerance = bound,
                    .tolerance_is = "a kick-drift method of second order at this step",
                    .source = "Hill's equations by Runge-Kutta, steps of 1e-4 orbits",
                    .command = "60 grains, 1 to 3.5 r_H off, that do not touch a moonlet of 10 m; seed 1, 2 orbits"});
  return rows;
}

std::vector<Row> bound_pairs() {
  std::vector<Row> rows;
  for (const auto& [step, bound] : {std::pair(1e-3, 4e-5), {5e-3, 1e-3}, {2e-2, 2e-2}}) {
    const Pair pair = bound_pair(step);
    rows.push_back({.what = fmt::format(
                        "bound pair at {:.2f} to {:.2f} contacts: Jacobi energy over G(M+m)/(R+r), change, step {}",
                        pair.nearest, pair.farthest, step),
                    .measured = pair.largest_change,
                    .expected = 0.0,
                    .tolerance = bound,
                    .tolerance_is = "a kick-drift method of second order at this step",
                    .source = "conservation of the Jacobi energy",
                    .command = "two spheres of 1 m and 1800 kg/m^3 that circle against the orbit, 100 orbits"});
  }
  return rows;
}

// The error falls as the square of the kick interval: contacts have the velocity of their own time.
std::vector<Row> rebounds() {
  std::vector<Row> rows;
  double twice_as_long = test::rebound_errors(300, 4e-3, 0.5).rms;
  for (const double interval : {2e-3, 1e-3, 5e-4}) {
    const double error = test::rebound_errors(300, interval, 0.5).rms;
    rows.push_back(
        {.what = fmt::format(
             "rebound under gravity: rms error of its speed over that at twice the interval, kicks of {}", interval),
         .measured = error / twice_as_long,
         .expected = 0.25,
         .tolerance = 0.025,
         .tolerance_is = "10 %, what is of higher order",
         .source = "second order, a contact at any phase of the kick interval",
         .command = "300 pairs of spheres of 1 m and 900 kg/m^3 that fall from 3 to 4 m, eps 0.5"});
    twice_as_long = error;
  }
  return rows;
}

} // namespace

std::vector<Subject> two_body_subjects() {
  return {{"encounters", "Two bodies", true, encounters},
          {"bound-pairs", "Two bodies", false, bound_pairs},
          {"rebounds", "Two bodies", true, rebounds}};
}

} // namespace keeler::validation
