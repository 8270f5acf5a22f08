#include <keeler/simulation/simulation.hpp>

#include "first_state.hpp"
#include "step_control.hpp"

#include <keeler/cells/order.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/contact_solver/resting_contacts.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/units.hpp>
#include <keeler/decomposition/blocks.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/forces/self_gravity.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cstring>

namespace keeler::simulation {
namespace {

constexpr double sorting_interval = 0.1; // orbits

// Work of one kick on all particles.
struct KickSums {
  ExactSum work, azimuthal_gain;

  KickSums& operator+=(const KickSums& more) {
    work += more.work;
    azimuthal_gain += more.azimuthal_gain;
    return *this;
  }
};

// A run stops and writes where self-gravity kicks: all forces must have received both halves of their kicks there.
void require_coinciding_kicks(const forces::Force& force, const std::string& name, const Scene& scene) {
  const std::int64_t every = force.kick_every(), interval = scene.gravity ? scene.gravity->kick_every : 1;
  if (every < 1 || interval % every != 0)
    throw UsageError(fmt::format("the force '{}' kicks every {} steps (it must be a divisor of gravity.kick_every, "
                                 "which is {}); correct the force, or change gravity.kick_every",
                                 name, every, interval));
}

std::vector<std::unique_ptr<forces::Force>> make_forces(const Scene& scene, const SimulationState& state,
                                                        const Communicator& ranks) {
  std::vector<double> masses;
  if (!state.forces.empty())
    for (const Body& body : state.particles.bodies)
      masses.push_back(body.mass);
  const forces::ForceContext context{masses, state.box, scene.planet.orbital_frequency, scene.particles.seed, ranks};
  std::vector<std::unique_ptr<forces::Force>> forces;
  if (scene.gravity)
    forces.push_back(make_self_gravity(*scene.gravity, context));
  for (const scene::ForceSettings& force : scene.external_forces) {
    forces.push_back(force.entry->make(force.parameters, context));
    require_coinciding_kicks(*forces.back(), force.entry->table, scene);
  }
  return forces;
}

} // namespace

Simulation::Simulation(const Scene& scene, const Patch& start, const Communicator& ranks)
    : Simulation(scene, first_state(scene, start, ranks), ranks) {
  if (ranks_.distributed()) {
    const cells::Overlap largest = largest_overlap_distributed();
    ranks_.together([&] { require_no_overlap(largest, start_name(scene_)); });
  }
  for (std::size_t f = 0; f < forces_.size(); ++f)
    accelerate(f);
}

Simulation::Simulation(const Scene& scene, SimulationState state, const Communicator& ranks)
    : scene_(scene), ranks_(ranks), state_(std::move(state)), count_(ranks.sum(state_.particles.size())),
      drift_(scene.collisions, scene.planet.frequencies, scene.planet.orbital_frequency, state_.step_length),
      resting_(std::make_unique<contact_solver::RestingContacts>()) {
  divide();
  forces_ = make_forces(scene_, state_, ranks_);
  find_moonlets();
  schedule_drift();
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&& other) noexcept = default;
Simulation& Simulation::operator=(Simulation&& other) noexcept = default;

EnergyBalance Simulation::balance() const {
  return balance(means());
}

void Simulation::advance() {
  assert(state_.control.fits(state_.step) && state_.step_length > 0.0);
  assert(state_.particles.ids.size() == state_.particles.size());
  sort_when_due();
  for (std::size_t f = 0; f < forces_.size(); ++f)
    if (kick_due(f))
      half_kick(f);
  persist_contacts_second_half();
  {
    const Stopwatch watch(split_.drift);
    drifting_ = true;
    collide();
    drifting_ = false;
    if (scene_.gravity) // the first of the forces
      state_.forces.front().work += drift_.kick_work();
    advance_epoch();
    undisturbed_ = true;
  }
  for (std::size_t f = 0; f < forces_.size(); ++f)
    if (kick_due(f)) {
      accelerate(f);
      half_kick(f);
    }
  const double interval = carries() ? kick_interval() : 0.0;
  decide_step_when_due();
  persist_contacts(interval);
}

void Simulation::collide() {
  if (ranks_.distributed())
    return collide_distributed();
  drift_.collide(state_.particles, state_.box, state_.epoch_offset(), state_.collisions, undisturbed_,
                 kicks_of_drift());
  note_slow_pairs();
}

// Returns the interval between kicks of self-gravity that the next drift is a part of.
collision::KickInterval Simulation::kicks_of_drift() const {
  if (!scene_.gravity)
    return {};
  const std::int64_t interval = ticks_between_kicks(0), since = state_.step % interval; // ticks
  return {state_.forces.front().accelerations,
          0.5 * static_cast<double>(interval - 2 * since - state_.control.step) * state_.tick(), at_rest_};
}

// Chooses the lengths of the next steps, at ticks where the kicks of all forces coincide. Moves the elements to the
// middle of the new step.
void Simulation::decide_step_when_due() {
  if (!scene_.time.automatic || state_.step % decision_ticks != 0)
    return;
  const Stopwatch watch(split_.advance);
  const double tick = state_.tick(), before = state_.step_length;
  state_.control = decide_step(state_.control, state_.collisions, count_, state_.step);
  state_.step_length = static_cast<double>(state_.control.step) * tick;
  schedule_drift();
  if (state_.step_length == before)
    return;
  rebase(0.5 * (state_.step_length - before));
  undisturbed_ = false;
}

void Simulation::schedule_drift() {
  const bool pairs = scene_.gravity && scene_.gravity->by_pairs();
  const double pull = pairs ? newton_g(scene_.planet.orbital_frequency) * kick_interval() : 0.0;
  drift_.set_step(state_.step_length, pull, carries() ? state_.resting.slow_limit() * pull : 0.0);
}

// Precondition: the order in memory has not changed since the drift.
void Simulation::note_slow_pairs() {
  for (const collision::SlowPair& pair : drift_.slow_pairs())
    resting_->note(state_.particles, pair);
}

// Returns the kicks at this boundary. `before` is the kick interval that ends here.
std::vector<contact_solver::KickPart> Simulation::kick_parts(double before) {
  std::vector<contact_solver::KickPart> parts;
  for (std::size_t f = 0; f < forces_.size(); ++f)
    if (kick_due(f)) {
      const double after = static_cast<double>(ticks_between_kicks(f)) * state_.tick();
      parts.push_back({state_.forces[f].accelerations, 0.5 * (f == 0 ? before : after), 0.5 * after,
                       &state_.forces[f].work, &state_.forces[f].azimuthal_gain});
    }
  return parts;
}

contact_solver::RestingStep Simulation::resting_step(Particles& particles,
                                                     std::span<const contact_solver::KickPart> kicks) const {
  return {particles,
          scene_.planet.frequencies,
          state_.box,
          state_.epoch_offset(),
          0.5 * state_.step_length,
          kick_interval(),
          newton_g(scene_.planet.orbital_frequency),
          kicks};
}

void Simulation::persist_contacts(double before) {
  assert(!carries() || before > 0.0);
  if (!carries() || !kick_due(0))
    return;
  const Stopwatch watch(split_.resting);
  if (ranks_.distributed())
    resting_->share_noted(ranks_);
  if (resting_->idle(state_.resting))
    return;
  with_members(before, [&](const contact_solver::RestingStep& step) {
    resting_->persist(state_.resting, step, scene_.collisions.friction, state_.collisions);
  });
  schedule_drift();
}

void Simulation::persist_contacts_second_half() {
  if (!carries() || !kick_due(0))
    return;
  at_rest_.clear();
  ids_at_rest_.clear();
  if (state_.resting.pairs.empty())
    return;
  const Stopwatch watch(split_.resting);
  with_members(kick_interval(), [&](const contact_solver::RestingStep& step) {
    at_rest_.assign(step.particles.size(), 0);
    resting_->persist_second_half(state_.resting, step, state_.collisions, at_rest_);
    if (ranks_.distributed())
      note_ids_at_rest(step.particles);
  });
}

// Calls function(step) with all particles of contacts at rest.
void Simulation::with_members(double before, const std::function<void(const contact_solver::RestingStep&)>& function) {
  const std::vector<contact_solver::KickPart> parts = kick_parts(before);
  if (ranks_.distributed())
    with_members_of_ranks(parts, function);
  else
    function(resting_step(state_.particles, parts));
  undisturbed_ = false;
}

// Sorts particles in memory by position every tenth of an orbit.
void Simulation::sort_when_due() {
  const std::int64_t longest = scene_.time.automatic ? scene::TimeSettings::longest : 1;
  const auto intervals = std::ceil(sorting_interval / (static_cast<double>(longest) * scene_.time.step));
  const std::int64_t interval = longest * static_cast<std::int64_t>(intervals);
  if (state_.step % interval != 0)
    return;
  if (ranks_.distributed())
    return blocks_->invalidate(); // the ghost layer is rebuilt, which sorts too
  const Stopwatch watch(split_.drift);
  drift_.release();
  undisturbed_ = false;
  const std::vector<std::uint32_t> order =
      cells::order_by_position(state_.particles, state_.box, state_.epoch_offset());
  cells::reorder(state_.particles.bodies, order);
  cells::reorder(state_.particles.ids, order);
  if (state_.particles.rough)
    cells::reorder(state_.particles.spins, order);
  for (ForceState& force : state_.forces)
    cells::reorder(force.accelerations, order);
  if (!at_rest_.empty())
    cells::reorder(at_rest_, order);
  resting_->reordered();
  own_by_id_.clear();
  find_moonlets();
}

// Moves the elements to the epoch of the next step.
void Simulation::advance_epoch() {
  const Stopwatch watch(split_.advance);
  state_.step += state_.control.step;
  ++state_.control.steps;
  rebase(state_.step_length);
}

// Moves the elements to another epoch, and back into the cell by guiding centre.
void Simulation::rebase(double time) {
  const hill::Rebase to_epoch(scene_.planet.frequencies, time);
  const double offset = state_.epoch_offset();
  const bool with_moonlets = !state_.moonlets.empty();
  moonlet_wraps_.assign(2 * state_.moonlets.size(), 0.0);
  parallel_for(state_.particles.size(), [&](std::size_t k) {
    state_.particles.prefetch_after(k);
    Elements& el = state_.particles.bodies[k].elements;
    to_epoch(el);
    const Image image = state_.box.image_into_cell(el.guiding_x, el.guiding_y, offset);
    if (image != Image{}) {
      el = state_.box.image_of(el, image, offset);
      if (with_moonlets)
        note_wrap(k, state_.box.displacement(image, offset));
    }
  });
  wrap_moonlets();
  if (state_.particles.rough) {
    const hill::FixedRotation turn(time); // of the stars relative to Hill's frame
    parallel_for(state_.particles.size(), [&](std::size_t k) {
      Vec3& spin = state_.particles.spins[k];
      turn.turn(spin.y(), spin.x());
    });
  }
}

forces::Boundary Simulation::boundary() const {
  return {state_.particles,         scene_.planet.frequencies,
          0.5 * state_.step_length, state_.box,
          state_.boundary_offset(), state_.step,
          two_pi * orbits(),        ranks_};
}

std::optional<gravity::GravityEnergy> Simulation::gravity_energy() const {
  return scene_.gravity ? forces_.front()->energy(boundary()) : std::nullopt; // self-gravity comes first
}

void Simulation::accelerate(std::size_t f) {
  const Stopwatch watch(split_.forces[state_.forces[f].name]);
  std::vector<Vec3>& accelerations = state_.forces[f].accelerations;
  accelerations.resize(state_.particles.size());
  drift_.release_contacts();
  forces::Boundary at = boundary();
  at.interval = static_cast<double>(ticks_between_kicks(f)) * state_.tick();
  forces_[f]->accelerate(at, accelerations);
}

// Applies half a kick interval's velocity change, at the boundary between steps. Two half kicks stay two additions.
void Simulation::half_kick(std::size_t f) {
  const Stopwatch watch(split_.forces[state_.forces[f].name]), kick_watch(split_.kick);
  ForceState& force = state_.forces[f];
  const Frequencies& frequencies = scene_.planet.frequencies;
  const Rotation rotation = boundary().rotation();
  const double half = 0.5 * state_.tick() * static_cast<double>(ticks_between_kicks(f));
  undisturbed_ = false;
  KickSums sums = exact_total<KickSums>(state_.particles.size(), [&](KickSums& total, std::size_t k) {
    state_.particles.prefetch_after(k);
    Body& body = state_.particles.bodies[k];
    const Vec3 dv = half * force.accelerations[k];
    total.work += body.mass * dv.dot(peculiar_velocity(body.elements, frequencies, rotation) + 0.5 * dv);
    total.azimuthal_gain += azimuthal_gain(body, dv, frequencies, rotation);
    kick(body.elements, dv, frequencies, rotation);
  });
  ranks_.merge({&sums.work, &sums.azimuthal_gain});
  force.work += sums.work.value();
  force.azimuthal_gain += sums.azimuthal_gain.value();
  std::vector<double> gains(moonlet_indices_.size(), 0.0);
  for (std::size_t k = 0; k < gains.size(); ++k)
    if (const std::size_t index = moonlet_indices_[k]; index != elsewhere)
      gains[k] = state_.particles.bodies[index].mass * half * force.accelerations[index].y();
  if (!gains.empty())
    sum_from_owners(gains);
  for (std::size_t k = 0; k < gains.size(); ++k)
    force.moonlet_gains[k] += gains[k];
}

void Simulation::replace(Particles particles) {
  assert(!ranks_.distributed() && state_.step % scene_.kick_interval() == 0 && particles.ids == state_.particles.ids);
  const Patch after = patch_of(particles);
  require_sound(after);
  cells::require_no_overlap(after, "the changed state");
  const diagnostics::ParticleMeans before = means();
  std::swap(state_.particles, particles);
  wrap_changed(particles);
  const diagnostics::ParticleMeans now = means();
  state_.energy.epicyclic += now.epicyclic_energy - before.epicyclic_energy;
  state_.energy.azimuthal += now.azimuthal - before.azimuthal;
  state_.energy.spin += now.spin.energy - before.spin.energy;
  drift_.release();
  undisturbed_ = false;
  *resting_ = contact_solver::RestingContacts();
  state_.resting.pairs.clear();
  state_.resting.loads.clear();
  forces_ = make_forces(scene_, state_, ranks_);
  for (std::size_t f = 0; f < forces_.size(); ++f)
    accelerate(f);
}

// Wraps changed particles into the cell, as they may be far from it. Others keep their bits since the last kick.
void Simulation::wrap_changed(const Particles& before) {
  const double offset = state_.epoch_offset();
  moonlet_wraps_.assign(2 * state_.moonlets.size(), 0.0);
  for (std::size_t k = 0; k < before.size(); ++k) {
    Elements& el = state_.particles.bodies[k].elements;
    if (std::memcmp(&el, &before.bodies[k].elements, sizeof el) == 0)
      continue;
    const Image image = state_.box.image_into_cell(el.guiding_x, el.guiding_y, offset);
    el = state_.box.image_of(el, image, offset);
    if (image != Image{} && !state_.moonlets.empty())
      note_wrap(k, state_.box.displacement(image, offset));
  }
  wrap_moonlets();
}

double Simulation::largest_overlap() {
  drift_.release(); // frees memory for the search
  return deepest_overlap().depth;
}

cells::Overlap Simulation::deepest_overlap() {
  return ranks_.distributed() ? largest_overlap_distributed() : cells::largest_overlap(patch());
}

diagnostics::ParticleMeans Simulation::means() const {
  return diagnostics::particle_means(state_.particles, scene_.planet.frequencies, -0.5 * state_.step_length, ranks_);
}

} // namespace keeler::simulation
