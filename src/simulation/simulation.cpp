#include <keeler/simulation/simulation.hpp>

#include <keeler/cells/order.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
namespace {

constexpr double sorting_interval = 0.1; // orbits
constexpr double allowed_overlap = 1e-8; // of a radius sum: where the inexact finders call a root; not what they miss

SimulationState first_state(const Scene& scene, const Patch& start) {
  require_sound(start);
  const Overlap overlap = largest_overlap(start);
  if (overlap.depth > allowed_overlap)
    throw InvariantError(fmt::format("particles {} and {} of the initial state overlap by {:.2e} of their radius sum; "
                                     "start from a state without overlaps",
                                     overlap.id_i, overlap.id_j, overlap.depth));
  const double largest = start.size() ? *std::max_element(start.radii.begin(), start.radii.end()) : 0.0;
  if (!(std::min(start.box.size_x, start.box.size_y) >= 2.0 * largest))
    throw UsageError(
        fmt::format("the box of the initial state, {:.4g} m x {:.4g} m, is smaller than its largest particle "
                    "({:.4g} m across); start from another state",
                    start.box.size_x, start.box.size_y, 2.0 * largest));
  SimulationState state;
  state.step_length = scene.step_length();
  state.box = start.box;
  state.box.shear = scene.planet.frequencies.shear();
  state.box.first_offset = start.offset;
  Patch patch = start;
  patch.frequencies = scene.planet.frequencies;
  state.particles = particles_from(patch, 0.5 * state.step_length);
  const double offset = state.epoch_offset();
  for (Body& body : state.particles.bodies) {
    Elements& el = body.elements;
    el = state.box.image_of(el, state.box.image_into_cell(el.guiding_x, el.guiding_y, offset), offset);
  }
  state.energy.start = total_energy(state.particles, scene.planet.frequencies);
  return state;
}

} // namespace

Simulation::Simulation(const Scene& scene, const Patch& start) : Simulation(scene, first_state(scene, start)) {
  if (solver_)
    accelerate();
}

Simulation::Simulation(const Scene& scene, SimulationState state)
    : scene_(scene), state_(std::move(state)),
      drift_(scene.collisions, scene.planet.frequencies, scene.planet.orbital_frequency, state_.step_length) {
  if (scene_.gravity) {
    for (const Body& body : state_.particles.bodies)
      masses_.push_back(body.mass);
    solver_ = make_gravity_solver(*scene_.gravity, masses_, state_.box.area());
  }
}

void Simulation::advance() {
  sort_when_due();
  if (kick_due())
    half_kick();
  {
    const Stopwatch watch(split_.drift);
    drift_.collide(state_.particles, state_.box, state_.epoch_offset(), state_.collisions);
    move_on();
    drift_.moved_on();
  }
  if (kick_due()) {
    accelerate();
    half_kick();
  }
}

// Memory order follows the places every tenth of an orbit. That depends on the step number alone: a restart goes on
// with the same order.
void Simulation::sort_when_due() {
  const auto interval = static_cast<std::int64_t>(std::ceil(sorting_interval / scene_.time.step));
  if (state_.step % interval != 0)
    return;
  const Stopwatch watch(split_.drift);
  drift_.forget();
  const std::vector<std::uint32_t> order = order_by_place(state_.particles, state_.box, state_.epoch_offset());
  reorder(state_.particles.bodies, order);
  reorder(state_.particles.ids, order);
  if (!state_.accelerations.empty())
    reorder(state_.accelerations, order);
}

// To the epoch of the next step, and back into the cell by guiding centre.
void Simulation::move_on() {
  const Stopwatch watch(split_.advance);
  const Frequencies& f = scene_.planet.frequencies;
  const Rebase rebase(f, state_.step_length);
  ++state_.step;
  const double offset = state_.epoch_offset();
  const double gain = -0.25 * f.shear() * f.kappa * f.kappa;
  state_.energy.wrap_work += ordered_sum(state_.particles.size(), [&](std::size_t k) {
    state_.particles.prefetch_after(k);
    Body& body = state_.particles.bodies[k];
    Elements& el = body.elements;
    rebase(el);
    const Image image = state_.box.image_into_cell(el.guiding_x, el.guiding_y, offset);
    if (image == Image{})
      return 0.0;
    const double before = el.guiding_x;
    el = state_.box.image_of(el, image, offset);
    return body.mass * gain * (el.guiding_x * el.guiding_x - before * before);
  });
}

// The solver sees the patch from another origin at each kick: where cells and meshes fall among the particles changes,
// and their errors do not add up from kick to kick. In a periodic box nothing else changes. The step number draws it,
// so that a restart goes on with the same ones.
Vec3 Simulation::random_origin() const {
  RandomStream random(scene_.particles.seed, RandomPurpose::gravity_origin, static_cast<std::uint64_t>(state_.step));
  const double x = random.uniform() - 0.5, y = random.uniform() - 0.5;
  return {x * state_.box.size_x, y * state_.box.size_y, 0.0};
}

void Simulation::accelerate() {
  const Stopwatch watch(split_.gravity);
  state_.accelerations.resize(state_.particles.size());
  const GravityProblem problem = gravity_problem(positions_, masses_);
  if (scene_.gravity->images.far) {
    const Vec3 origin = random_origin();
    parallel_for(positions_.size(), [&](std::size_t k) { positions_[k] -= origin; });
  }
  solver_->accelerate(problem, state_.accelerations);
}

// Half a kick interval's velocity change, at the boundary between steps. Two half kicks are always two additions.
void Simulation::half_kick() {
  const Stopwatch watch(split_.gravity), kick_watch(split_.kick);
  const Frequencies& f = scene_.planet.frequencies;
  const Rotation rotation(f, -0.5 * state_.step_length);
  const double half = 0.5 * state_.step_length * scene_.gravity->kick_every;
  const double largest =
      largest_of(state_.accelerations.size(), [&](std::size_t k) { return state_.accelerations[k].squaredNorm(); });
  drift_.kicked(half * std::sqrt(largest));
  state_.energy.kick_work += ordered_sum(state_.particles.size(), [&](std::size_t k) {
    state_.particles.prefetch_after(k);
    Body& body = state_.particles.bodies[k];
    const Vec3 dv = half * state_.accelerations[k];
    const Vec3 v = state_at(body.elements, f, rotation).velocity;
    kick(body.elements, dv, f, rotation);
    return body.mass * (v.dot(dv) + 0.5 * dv.squaredNorm());
  });
}

GravityProblem Simulation::gravity_problem(std::vector<Vec3>& positions, std::vector<double>& masses) const {
  const std::size_t count = state_.particles.size();
  const Rotation rotation(scene_.planet.frequencies, -0.5 * state_.step_length);
  positions.resize(count);
  masses.resize(count);
  parallel_for(count, [&](std::size_t k) {
    state_.particles.prefetch_after(k);
    const Body& body = state_.particles.bodies[k];
    positions[k] = state_at(body.elements, scene_.planet.frequencies, rotation).position;
    masses[k] = body.mass;
  });
  return {positions,
          masses,
          state_.particles.ids,
          state_.box,
          state_.boundary_offset(),
          newton_g(scene_.planet.orbital_frequency)};
}

Patch Simulation::patch() const {
  Patch patch = make_patch(state_.particles, state_.box, state_.boundary_offset(), scene_.planet.frequencies,
                           -0.5 * state_.step_length);
  patch.orbital_frequency = scene_.planet.orbital_frequency;
  patch.time_orbits = orbits();
  return patch;
}

double Simulation::energy_residual() const {
  const EnergyBudget& e = state_.energy;
  return total_energy(state_.particles, scene_.planet.frequencies) - e.start - e.kick_work - e.wrap_work -
         state_.collisions.edge_work + state_.collisions.energy_lost;
}

} // namespace keeler
