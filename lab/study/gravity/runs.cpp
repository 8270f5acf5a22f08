#include "runs.hpp"

#include <keeler/bench/gravity_states.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/diagnostics/analysis.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler {
namespace {

constexpr std::size_t run_particles = 3750; // 2.5 λ_cr square
constexpr int common_interval = 5;          // steps, for all solvers: the sum over all pairs is expensive
constexpr int kick_intervals[] = {1, 2, 5, 10};
constexpr long block_steps = 10;                            // a common multiple of all kick intervals
constexpr double start_fraction = 0.375, forgetting = 0.25; // of the measured orbits
constexpr double snapshots_per_orbit = 10.0;

GravityChoice with_interval(GravityChoice choice, int kick_every) {
  choice.settings.kick_every = kick_every;
  return choice;
}

// Returns the steps in `orbits`, rounded to whole blocks, at least one.
long steps_of(double orbits, const Scene& scene) {
  assert(scene.time.step > 0.0);
  return block_steps * std::max(1L, std::lround(orbits / (scene.time.step * block_steps)));
}

void advance_steps(Simulation& simulation, long steps) {
  for (long k = 0; k < steps; ++k)
    simulation.advance();
}

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

} // namespace

std::vector<GravityChoice> gravity_run_choices() {
  std::vector<GravityChoice> choices;
  for (const std::string& solver : gravity_solver_names())
    choices.push_back(with_interval(default_gravity_choice(solver), common_interval));
  for (const int interval : kick_intervals)
    if (interval != common_interval)
      choices.push_back(with_interval(default_gravity_choice("tree"), interval));
  return choices;
}

std::string run_label(const GravityChoice& choice) {
  const int every = choice.settings.kick_every;
  return fmt::format("{}, {}, {}", choice.solver, choice.text,
                     every == 1 ? "a kick every step" : fmt::format("a kick every {} steps", every));
}

std::vector<std::pair<std::string, std::string>> gravity_run_comparisons() {
  const auto label = [](const std::string& solver, int interval) {
    return run_label(with_interval(default_gravity_choice(solver), interval));
  };
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& solver : gravity_solver_names())
    if (solver != "direct")
      pairs.emplace_back(label(solver, common_interval), label("direct", common_interval));
  for (const int interval : kick_intervals)
    if (interval != 1)
      pairs.emplace_back(label("tree", interval), label("tree", 1));
  return pairs;
}

const std::vector<RunQuantity>& run_quantities() {
  static const std::vector<RunQuantity> quantities = {
      {"dispersion_r_omega", "c_x (r Ω)"},
      {"collisions_per_particle_orbit", "collisions per particle and orbit"},
      {"dissipation_r2_omega2", "energy lost per mass and orbit (r² Ω²)"},
      {"wake_amplitude", "wake amplitude"},
      {"wake_spacing", "wake spacing (λ_cr)"},
      {"wake_pitch_degrees", "wake pitch (degrees)"}};
  return quantities;
}

RunStart gravity_run_start(std::uint64_t seed, double orbits) {
  PhaseProgress silent({});
  RunStart start{a_ring_scene(run_particles, seed), {}};
  start.patch = evolved_with_gravity(start.scene, start_fraction * orbits, silent);
  return start;
}

std::size_t gravity_run_count() {
  return a_ring_scene(run_particles, 1).particles.count;
}

Json gravity_run(const RunStart& start, const GravityChoice& choice, double orbits) {
  assert(orbits > 0.0 && block_steps % choice.settings.kick_every == 0);
  Scene scene = start.scene;
  scene.gravity = choice.settings;
  Simulation simulation(scene, start.patch);
  advance_steps(simulation, steps_of(forgetting * orbits, scene));
  const CollisionTally before = simulation.state().collisions;
  const double residual_before = simulation.balance().residual;
  const long steps = steps_of(orbits, scene), every = steps_of(1.0 / snapshots_per_orbit, scene);
  std::vector<Patch> patches;
  for (long done = 0; done < steps; done += block_steps) {
    advance_steps(simulation, block_steps);
    if ((done + block_steps) % every == 0 || done + block_steps == steps)
      patches.push_back(simulation.patch());
  }
  const Analysis a = analyze(patches);
  const CollisionTally& after = simulation.state().collisions;
  const double measured = static_cast<double>(steps) * scene.time.step, mass = total_mass(patches.back());
  const double lost = after.energy_lost - before.energy_lost, r = a.mean_radius_m;
  std::optional<double> spacing = a.wake_spacing_m;
  if (spacing)
    *spacing /= a.critical_wavelength_m;
  return {{"solver", choice.solver},
          {"settings", choice.text},
          {"kick_every", choice.settings.kick_every},
          {"seed", scene.particles.seed},
          {"dispersion_r_omega", a.dispersion_r_omega[0]},
          {"collisions_per_particle_orbit",
           2.0 * static_cast<double>(after.fast - before.fast) / (static_cast<double>(a.particle_count) * measured)},
          {"dissipation_r2_omega2", lost / (mass * r * r * measured)},
          {"wake_amplitude", a.wake_amplitude},
          {"wake_spacing", or_null(spacing)},
          {"wake_pitch_degrees", or_null(a.wake_pitch_degrees)},
          {"energy_residual", lost > 0.0 ? std::fabs(simulation.balance().residual - residual_before) / lost : 0.0}};
}

double gravity_run_cost(const GravityChoice& choice, double orbits) {
  const double count = run_particles, drift = 0.4e-6;
  const double gravity = choice.solver == "direct" ? 9.0 * count / 1e9 : 1e-6; // s per particle and solve
  const double steps = (1.0 + forgetting) * orbits * 1e3;
  return steps * count * (drift + gravity / choice.settings.kick_every) / threads();
}

} // namespace keeler
