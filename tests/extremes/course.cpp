#include "course.hpp"

#include "unit/collision/plain_drift.hpp"
#include "unit/collision/same_bits.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::extremes {
namespace {

// Σ m e and Σ m i as complex numbers, turned back to the first epoch.
struct VectorSums {
  std::complex<double> e = 0.0, i = 0.0;
  double scale = 0.0; // Σ m (e + i)

  VectorSums(const simulation::SimulationState& state, const Frequencies& f) {
    for (const Body& b : state.particles.bodies) {
      const Elements& el = b.elements;
      e += b.mass * std::complex<double>(el.e_cos, el.e_sin);
      i += b.mass * std::complex<double>(el.i_cos, el.i_sin);
      scale += b.mass * (el.eccentricity() + el.inclination());
    }
    e *= back(f.kappa, state);
    i *= back(f.nu, state);
  }

  static std::complex<double> back(double frequency, const simulation::SimulationState& state) {
    const long double turn = static_cast<long double>(frequency * state.step_length) * state.step;
    return std::polar(1.0, -static_cast<double>(std::fmod(turn, 2.0L * std::numbers::pi_v<long double>)));
  }
};

double energy_scale(const simulation::SimulationState& state, const Frequencies& f) {
  double sum = 0.0;
  for (const Body& b : state.particles.bodies)
    sum += b.mass * (std::pow(b.elements.eccentricity(), 2) + std::pow(f.nu * b.elements.inclination(), 2));
  return sum;
}

double smallest_radius(const simulation::SimulationState& state) {
  double smallest = 1e300;
  for (const Body& b : state.particles.bodies)
    smallest = std::min(smallest, b.radius);
  return smallest;
}

std::uint64_t contacts_of(const Simulation& simulation) {
  return simulation.state().collisions.fast + simulation.state().collisions.slow;
}

} // namespace

Example example(const std::string& name, const std::string& scene, const std::vector<std::string>& overrides) {
  const std::string file = fmt::format("examples/{}/scene.toml", scene);
  std::string command = "keeler run " + file;
  for (const std::string& key : overrides)
    command += fmt::format(" --set '{}'", key);
  return {load_scene(std::string(KEELER_SOURCE_DIR) + "/" + file, overrides), {name, command}};
}

Course follow(Simulation& simulation, std::int64_t steps, int looks) {
  const Frequencies f = simulation.patch().frequencies;
  const simulation::SimulationState& state = simulation.state();
  const VectorSums before(state, f);
  Course course;
  course.steps = steps;
  course.rounding = 1e-15 * (state.box.size_x + state.box.size_y) / smallest_radius(state) + 1e-14;
  for (std::int64_t k = 1; k <= steps; ++k) {
    const std::uint64_t so_far = contacts_of(simulation);
    simulation.advance();
    const auto hits = static_cast<double>(contacts_of(simulation) - so_far);
    course.worst_step = std::max(course.worst_step, 2.0 * hits / static_cast<double>(state.particles.size()));
    if (k % std::max<std::int64_t>(1, steps / looks) == 0)
      course.overlap = std::max(course.overlap, cells::largest_overlap(simulation.patch()).depth);
  }
  const VectorSums after(state, f);
  course.collisions = contacts_of(simulation);
  course.momentum = (std::abs(after.e - before.e) + std::abs(after.i - before.i)) / std::max(before.scale, after.scale);
  course.energy = std::fabs(simulation.balance().residual) / (energy_scale(state, f) + state.collisions.energy_lost);
  return course;
}

Course follow(const Scene& scene, std::int64_t steps, int looks) {
  Simulation simulation(scene, initial_patch(scene));
  return follow(simulation, steps, looks);
}

std::vector<Row> rows_of(const State& state, const Course& course, double least) {
  const double roundings = static_cast<double>(course.collisions) + static_cast<double>(course.steps);
  const double walked = 1e-15 * (10.0 + std::sqrt(roundings));
  return {at_least(state, "contacts", static_cast<double>(course.collisions), least, "else nothing is tested"),
          at_most(state, "deepest overlap over the radius sum", course.overlap, course.rounding,
                  "rounding of places as large as the box: 1e-15 of it over the smallest radius"),
          at_most(state, "change of Σme and Σmi over Σm(e + i)", course.momentum, walked,
                  "1e-15 a rounding, which walk: (10 + √(contacts + steps))"),
          at_most(state, "energy that the budget leaves open, over Σm(e² + ν²i²) and what was lost", course.energy,
                  walked, "the same")};
}

AgainstPlain& AgainstPlain::operator+=(const AgainstPlain& more) {
  steps += more.steps;
  differing += more.differing;
  collisions += more.collisions;
  overlap = std::max(overlap, more.overlap);
  return *this;
}

AgainstPlain against_plain(test::Ring& ring, const collision::CollisionSettings& settings, int steps) {
  test::PlainDrift plain(settings, ring.frequencies, test::omega, ring.step);
  ring.keeps_neighbours = true;
  AgainstPlain course;
  for (; course.steps < static_cast<std::size_t>(steps); ++course.steps) {
    Particles copy = ring.particles;
    CollisionTally tally, plain_tally;
    ring.collide(tally);
    course.collisions += plain.collide(copy, ring.box, ring.epoch_offset(), plain_tally).size();
    if (!test::same_bits(ring.particles, copy) || !test::same_bits(tally, plain_tally))
      ++course.differing;
    ring.move_on();
    course.overlap = std::max(course.overlap, cells::largest_overlap(ring.patch()).depth);
  }
  return course;
}

std::vector<Row> rows_of(const State& state, const AgainstPlain& course, double rounding, double least) {
  return {at_least(state, "contacts", static_cast<double>(course.collisions), least, "else nothing is tested"),
          exactly(state, fmt::format("steps of {} that differ in a bit from the plain algorithm", course.steps),
                  static_cast<double>(course.differing), 0.0, "docs/dev/drift.md"),
          at_most(state, "deepest overlap over the radius sum", course.overlap, rounding,
                  "rounding of places as large as the box")};
}

} // namespace keeler::extremes
