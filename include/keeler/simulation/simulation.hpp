// The step: kick–drift–kick. The forces' half kicks, a drift with its collisions, the forces' half kicks; the kicks of
// a force only every k-th drift, and none at all in a scene without forces.
//
// Of a run that ranks share each rank has a Simulation of its own particles: state().particles, and the accelerations.
// All else of the state is that of the whole run, on each. What is said to be collective all ranks call at once.
#pragma once

#include <keeler/cells/overlap.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/contact_solver/resting_contacts.hpp>
#include <keeler/decomposition/slabs.hpp>
#include <keeler/forces/force.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/state.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler {

/// Wall time spent in each part since construction, s.
struct TimeSplit {
  double drift = 0.0;
  double advance = 0.0;                 ///< of the drift: to the next epoch and back into the cell
  double kick = 0.0;                    ///< of the forces: their half kicks
  double resting = 0.0;                 ///< impulses of contacts at rest
  std::map<std::string, double> forces; ///< by name, the half kicks included

  /// 0 for a force that the scene has not.
  double force(const std::string& name) const {
    const auto found = forces.find(name);
    return found == forces.end() ? 0.0 : found->second;
  }
};

class Simulation {
public:
  /// A new run from a patch; time starts at zero. Throws InvariantError when particles overlap by more than rounding.
  /// Collective, as all that follows from it: each rank gives a part of the particles, whichever, and the first one all
  /// else of the patch. Throws UsageError for what the scene asks for and ranks cannot share yet.
  Simulation(const Scene& scene, const Patch& start, const Communicator& ranks = {});

  /// A run that goes on from a state, to the bit. Collective: each rank gives a part of the particles, whichever, with
  /// their accelerations, and all else of the state.
  Simulation(const Scene& scene, SimulationState state, const Communicator& ranks = {});

  /// One step; collective. Throws InvariantError, or Interrupted when an Interruptible (interrupt.hpp) asks for it; the
  /// state is then that of an unfinished step and must not be stored.
  void advance();

  /// The same particles with other elements, radii, masses or spins, given from outside where kicks meet (the step is a
  /// multiple of the scene's kick_interval()). Ids and their order must be those of the state. The energy that this
  /// brings counts as part of the start. Throws InvariantError, and then nothing has changed, when a number is not
  /// finite or particles overlap by more than rounding.
  void replace(Particles particles);

  /// After advance() or replace() has thrown: the state of before is the state again. It may be looked at, but no step
  /// may follow: for that a simulation is to be made of it.
  void put_back(SimulationState state) noexcept {
    state_ = std::move(state);
    drifting_ = undisturbed_ = false;
  }

  const SimulationState& state() const { return state_; }
  /// The state itself, its arrays where they are in memory; nothing else may be asked of the simulation afterwards.
  SimulationState take_state() && { return std::move(state_); }
  /// Throws UsageError for what a scene of so many particles asks for and ranks cannot share yet. In builds with ranks.
  static void require_distributable(const Scene& scene, std::size_t count);

  const Communicator& ranks() const { return ranks_; }
  /// Particles of all ranks.
  std::size_t count() const { return count_; }
  double orbits() const { return static_cast<double>(state_.step) * scene_.time.step; }

  /// The id of the first moonlet; of none the number of particles.
  std::uint64_t first_moonlet() const { return count_ - state_.moonlets.size(); }
  /// The body of a moonlet, k < state().moonlets.size(). Collective.
  Body moonlet(std::size_t k) const;

  /// A Cartesian copy of the present state. Not of a run that ranks share: nobody has all its particles.
  Patch patch() const;
  /// The same without particles.
  Patch frame() const;
  /// Collective: on the first rank piece(patch) for the particles of all ranks in the order of their ids, `rows` at a
  /// time, fewer the last time. What it throws all ranks throw.
  void visit_patch(std::size_t rows, const std::function<void(const Patch&)>& piece) const;

  /// The same when advance() has thrown: of the last boundary, or, in the middle of a drift, of the time of the last
  /// contact that was carried out.
  Patch patch_at_break() const;
  /// That time, in rad from the epoch of the elements, and the box's shear offset then.
  double time_at_break() const { return drifting_ ? drift_.reached() : -0.5 * state_.step_length; }
  double offset_at_break() const;

  /// The particles at this boundary between steps, as forces see them; not to be kept beyond the next step.
  Boundary boundary() const;

  /// The energy and the stress of self-gravity at this boundary, where it acts and has them. Collective.
  std::optional<GravityEnergy> gravity_energy() const;

  /// Means over all particles now, at this boundary. Collective.
  ParticleMeans means() const;

  /// How deep two particles stand inside each other at this boundary at most, of the sum of their radii; 0 when none
  /// do. Collective. The order in memory may change, and the next step makes its lists anew.
  double largest_overlap();

  /// Where the energy of the random motions came from and went. Collective.
  EnergyBalance balance() const { return balance(means()); }
  /// The same where the means are known already.
  EnergyBalance balance(const ParticleMeans& now) const { return state_.balance(now, scene_.planet.frequencies); }

  const TimeSplit& time_split() const { return split_; }

  /// What contacts at rest took at the last kick.
  const RestingCosts& resting_costs() const { return resting_.costs(); }

  /// Ticks from kick to kick of state().forces[f], where the present step begins.
  std::int64_t ticks_between_kicks(std::size_t f) const {
    return state_.control.kick > 0 ? state_.control.kick : forces_[f]->kick_every();
  }

  /// To watch collisions, or to measure finders.
  DriftPhase& drift() { return drift_; }

private:
  static constexpr std::size_t elsewhere = ~std::size_t{0};

  // of a run that ranks share (shared.cpp)
  void divide();
  void require_ghost_layer();
  void collide_distributed();
  Overlap largest_overlap_distributed();
  Slabs::Holding holding();

  void collide();
  Patch patch_of(const Particles& particles) const;
  Patch patch_of(const Particles& particles, double offset, double after) const;
  void wrap_changed(const Particles& before);
  void accelerate(std::size_t f);
  void half_kick(std::size_t f);
  void move_on();
  void rebase(double time);
  void sort_when_due();
  void decide_when_due();
  void find_moonlets();
  void from_owners(std::span<double> numbers) const;
  void note_wrap(std::size_t k, const Vec3& shift);
  void wrap_moonlets();
  void set_pace();
  bool carries() const { return scene_.gravity && scene_.gravity->carries(); }
  double kick_interval() const { return static_cast<double>(ticks_between_kicks(0)) * state_.tick(); }
  void note_slow_pairs();
  void carry_resting(double before);
  void carry_on_resting();
  template<class Carry> void with_kicks(double before, const Carry& carry);
  bool kick_due(std::size_t f) const { return state_.step % ticks_between_kicks(f) == 0; }

  Scene scene_;
  Communicator ranks_;
  SimulationState state_;
  std::size_t count_;
  DriftPhase drift_;
  bool drifting_ = false;                      // until collisions are carried out
  bool undisturbed_ = false;                   // the particles, but for moving on, since the last drift
  std::vector<std::unique_ptr<Force>> forces_; // in the order of state_.forces
  RestingContacts resting_;
  std::unique_ptr<Slabs> slabs_;            // only of a run that ranks share
  std::vector<std::size_t> moonlet_places_; // in memory; elsewhere for those of other ranks
  std::vector<double> moonlet_wraps_;       // x and y by which each has gone round an edge just now, m
  TimeSplit split_;
};

} // namespace keeler
