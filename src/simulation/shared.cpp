// A run that ranks share: docs/dev/ranks.md.
#include <keeler/simulation/simulation.hpp>

#include <keeler/collision/settings.hpp>
#include <keeler/contacts/finders.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

namespace keeler {
namespace {

// To the first rank, in the order of the ranks.
template<class Row> std::vector<Row> gathered(const Ranks& ranks, const std::vector<Row>& rows) {
  std::vector<std::vector<Row>> sent(ranks.count());
  sent[0] = rows;
  std::vector<std::vector<Row>> received = ranks.exchange(sent);
  std::size_t count = 0;
  for (const std::vector<Row>& some : received)
    count += some.size();
  std::vector<Row> all;
  all.reserve(count);
  for (std::vector<Row>& some : received) {
    all.insert(all.end(), some.begin(), some.end());
    std::vector<Row>().swap(some);
  }
  return all;
}

} // namespace

// What has an order, a place or a network of all particles still.
void Simulation::require_shareable(const Scene& scene, std::size_t count) {
  const auto refuse = [](const char* what, const char* instead) {
    throw UsageError(fmt::format("{} cannot be shared by several ranks; {}, or run on one", what, instead));
  };
  if (scene.gravity) {
    const GravitySettings gravity = chosen_for(count, *scene.gravity);
    if (gravity.solver != GravitySettings::Solver::fft && gravity.solver != GravitySettings::Solver::mesh)
      refuse("this gravity.solver", "set gravity.solver to \"fft\"");
    if (gravity.carries())
      refuse("contacts at rest that carry kicks", "set gravity.resting_contacts to \"bounced\"");
  }
  if (!make_finder(scene.collisions.finder)->exact())
    refuse("an inexact finder", "set collisions.finder to \"certified\"");
}

void Simulation::divide() {
  if (!ranks_.many())
    return;
  ranks_.together([&] { require_shareable(scene_, count_); });
  slabs_ = std::make_unique<Slabs>(ranks_, state_.box, scene_.planet.frequencies);
  slabs_->divide(holding());
}

// The particles, and the accelerations of their last kicks, which the next half kick needs.
Slabs::Holding Simulation::holding() {
  Slabs::Holding holding{state_.particles, {}};
  for (ForceState& force : state_.forces)
    holding.rows.push_back(&force.accelerations);
  return holding;
}

void Simulation::collide_shared() {
  const double offset = state_.epoch_offset();
  for (;;) {
    if (!slabs_->serve(state_.particles, state_.step_length)) {
      drift_.release();
      slabs_->make_borders(holding(), offset, state_.step_length);
      find_moonlets();
    }
    slabs_->add_copies(state_.particles);
    const bool done =
        drift_.collide_shared(state_.particles, slabs_->borders(), ranks_, state_.box, offset, state_.collisions);
    slabs_->drop_copies(state_.particles);
    if (done)
      return;
    slabs_->widen();
  }
}

Particles Simulation::all_particles() const {
  const Particles& own = state_.particles;
  Particles all;
  all.bodies = gathered(ranks_, own.bodies);
  all.ids = gathered(ranks_, own.ids);
  all.rough = own.rough;
  if (own.rough)
    all.spins = gathered(ranks_, own.spins);
  return all;
}

std::optional<GravityEnergy> Simulation::measure_whole(GravityMeter& meter) const {
  const Particles all = all_particles();
  if (!ranks_.is_first())
    return std::nullopt;
  return meter.measure({all, scene_.planet.frequencies, 0.5 * state_.step_length, state_.box, state_.boundary_offset(),
                        state_.step, two_pi * orbits(), Ranks()});
}

void Simulation::gather(SimulationState& state) const {
  state.particles = all_particles();
  for (std::size_t f = 0; f < state.forces.size(); ++f)
    state.forces[f].accelerations = gathered(ranks_, state_.forces[f].accelerations);
}

} // namespace keeler
