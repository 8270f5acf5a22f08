// Time integration: one step is kick, drift, kick. The half kicks of all forces surround a drift with its collisions. A
// force kicks only every k-th drift; a scene without forces has no kicks.
//
// In a distributed run each rank has a Simulation with its own particles: state().particles and the accelerations. All
// other state is global and equal on each rank. All ranks must call a collective function together.
#pragma once

#include <keeler/comm/communicator.hpp>
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

namespace keeler::contact_solver {
class RestingContacts;
struct KickPart;
struct RestingStep;
} // namespace keeler::contact_solver

namespace keeler::decomposition {
class Blocks;
struct Holding;
} // namespace keeler::decomposition

namespace keeler::cells {
struct Overlap;
} // namespace keeler::cells

namespace keeler::diagnostics {
struct ParticleMeans;
} // namespace keeler::diagnostics

namespace keeler::simulation {

/// Wall time of each part since construction, s.
struct TimeSplit {
  double drift = 0.0;                   ///< collisions and the move to the next epoch
  double advance = 0.0;                 ///< part of drift: move to the next epoch, wrap into the cell
  double kick = 0.0;                    ///< part of the forces: half kicks
  double resting = 0.0;                 ///< impulses of contacts at rest
  std::map<std::string, double> forces; ///< by name, half kicks included

  /// Returns 0 for a force that the scene does not have.
  double force(const std::string& name) const {
    const auto found = forces.find(name);
    return found == forces.end() ? 0.0 : found->second;
  }
};

/// Runs a scene in memory, step by step; nothing is written.
class Simulation {
public:
  /// Starts a run from a patch, at time zero. Collective, as all that follows from it: each rank gives any part of the
  /// particles, and the root the rest of the patch. Throws InvariantError if particles overlap by more than rounding.
  Simulation(const Scene& scene, const Patch& start, const Communicator& ranks = {});

  /// Continues a run from a state, bit for bit. Collective: each rank gives any part of the particles, with their
  /// accelerations, and all other state.
  Simulation(const Scene& scene, SimulationState state, const Communicator& ranks = {});
  ~Simulation();
  Simulation(Simulation&& other) noexcept;            ///< leaves `other` unusable
  Simulation& operator=(Simulation&& other) noexcept; ///< leaves `other` unusable

  /// Advances by one step; collective. Throws InvariantError, or Interrupted at the request of an Interruptible
  /// (interrupt.hpp). After that the state is that of an unfinished step and must not be stored.
  void advance();

  /// Replaces elements, radii, masses or spins by values from outside; counts the change of energy as part of the
  /// start. Preconditions: one rank, the step is a multiple of the scene's kick_interval(), and ids and order equal
  /// to the state. Throws InvariantError, and then changes nothing, if a number is not finite or particles
  /// overlap by more than rounding.
  void replace(Particles particles);

  /// Restores an earlier state after advance() or replace() has thrown. It may be read, but not advanced: for that,
  /// make a new simulation from it.
  void put_back(SimulationState state) noexcept {
    state_ = std::move(state);
    drifting_ = undisturbed_ = false;
    own_by_id_.clear();
  }

  const SimulationState& state() const { return state_; } ///< at this boundary
  /// Moves the state out, its arrays in their order in memory. The simulation must not be used afterwards.
  SimulationState take_state() && { return std::move(state_); }

  const Communicator& ranks() const { return ranks_; } ///< of the run
  /// Returns the number of particles of all ranks.
  std::size_t count() const { return count_; }
  double orbits() const { return static_cast<double>(state_.step) * scene_.time.step; } ///< since the run began

  /// Returns the id of the first moonlet, or the number of particles if there is none.
  std::uint64_t first_moonlet() const { return count_ - state_.moonlets.size(); }
  /// Returns the body of a moonlet. Collective. Precondition: k < state().moonlets.size().
  Body moonlet(std::size_t k) const;

  /// Returns on all ranks the bodies of particles by id. Collective: all ranks give the same ids. Precondition: the ids
  /// increase, and there are such particles.
  std::vector<Body> bodies_of(std::span<const std::uint64_t> ids);

  /// Returns a Cartesian copy of the state. Precondition: not distributed.
  Patch patch() const;
  /// Returns such a patch without its particles.
  Patch frame() const;
  /// Calls piece(patch) on the root for the particles of all ranks in the order of their ids, `rows` at a time, the
  /// remainder last. Collective: all ranks throw what `piece` throws.
  void visit_patch(std::size_t rows, const std::function<void(const Patch&)>& piece) const;

  /// Returns a patch after advance() has thrown: at the last boundary or, within a drift, at the time of the last
  /// contact.
  Patch patch_at_break() const;
  /// Calls piece(patch) on the root for the particles of all ranks after advance() has thrown on all of them, as
  /// visit_patch() does, but without particles k of which `keeps`(patch, k) is false; before them begin(frame, count),
  /// on the root. Returns how many are left out. Collective.
  std::size_t visit_at_break(std::size_t rows, const std::function<bool(const Patch&, std::size_t)>& keeps,
                             const std::function<void(const Patch&, std::size_t)>& begin,
                             const std::function<void(const Patch&)>& piece) const;
  /// Returns that time, in rad from the epoch of the elements. Collective, as the two that follow from it.
  double time_at_break() const { return drifting_ ? ranks_.max(drift_.reached()) : -0.5 * state_.step_length; }
  double offset_at_break() const; ///< the box's shear offset at that time, m

  /// Returns the particles at this boundary as forces see them. Valid until the next step.
  forces::Boundary boundary() const;

  /// Returns the energy and the stress of self-gravity at this boundary, if it acts and has them. Collective.
  std::optional<gravity::GravityEnergy> gravity_energy() const;

  /// Returns means over all particles at this boundary. Collective.
  diagnostics::ParticleMeans means() const;

  /// Returns the deepest overlap of two particles at this boundary in units of the sum of their radii; 0 if there is
  /// none. Collective. May change the order in memory; the next step rebuilds its lists.
  double largest_overlap();
  /// Returns that overlap with its two particles; collective. On one rank nothing in memory changes.
  cells::Overlap deepest_overlap();

  /// Returns the balance of the energy of random motions. Collective.
  EnergyBalance balance() const;
  /// As above, with means that are known already.
  EnergyBalance balance(const diagnostics::ParticleMeans& now) const {
    return state_.balance(now, scene_.planet.frequencies);
  }

  const TimeSplit& time_split() const { return split_; } ///< up to now

  /// Returns the ticks from kick to kick of state().forces[f], for the current step.
  std::int64_t ticks_between_kicks(std::size_t f) const {
    return state_.control.kick > 0 ? state_.control.kick : forces_[f]->kick_every();
  }

  /// Returns the division of the box over ranks, for measurements; nullptr unless distributed.
  const decomposition::Blocks* blocks() const { return blocks_.get(); }

  /// For observers of collisions and measurements of finders.
  collision::DriftPhase& drift() { return drift_; }

private:
  static constexpr std::size_t elsewhere = ~std::size_t{0};

  // in distributed runs (distributed.cpp)
  void divide();
  void require_ghost_layer();
  void collide_distributed();
  cells::Overlap largest_overlap_distributed();
  decomposition::Holding holding();
  // contacts at rest in distributed runs (distributed_resting.cpp)
  void with_members_of_ranks(std::span<const contact_solver::KickPart> parts,
                             const std::function<void(const contact_solver::RestingStep&)>& function);
  std::vector<std::uint32_t> own_among(std::span<const std::uint64_t> ids, std::size_t own);
  void note_ids_at_rest(const Particles& members);
  void mark_at_rest();

  void collide();
  collision::KickInterval kicks_of_drift() const;
  Patch patch_of(const Particles& particles) const;
  Patch patch_of(const Particles& particles, double offset, double after) const;
  void wrap_changed(const Particles& before);
  void accelerate(std::size_t f);
  void half_kick(std::size_t f);
  void advance_epoch();
  void rebase(double time);
  void sort_when_due();
  void decide_step_when_due();
  void find_moonlets();
  void sum_from_owners(std::span<double> numbers) const;
  void note_wrap(std::size_t k, const Vec3& shift);
  void wrap_moonlets();
  void schedule_drift();
  bool carries() const { return scene_.gravity && scene_.gravity->carries(); }
  double kick_interval() const { return static_cast<double>(ticks_between_kicks(0)) * state_.tick(); }
  void note_slow_pairs();
  void persist_contacts(double before);
  void persist_contacts_second_half();
  std::vector<contact_solver::KickPart> kick_parts(double before);
  contact_solver::RestingStep resting_step(Particles& particles, std::span<const contact_solver::KickPart> kicks) const;
  void with_members(double before, const std::function<void(const contact_solver::RestingStep&)>& function);
  bool kick_due(std::size_t f) const { return state_.step % ticks_between_kicks(f) == 0; }

  Scene scene_;
  Communicator ranks_;
  SimulationState state_;
  std::size_t count_;
  collision::DriftPhase drift_;
  bool drifting_ = false;                              // a drift has begun and not ended
  bool undisturbed_ = false;                           // particles have only moved since the last drift
  std::vector<std::unique_ptr<forces::Force>> forces_; // in the order of state_.forces
  std::unique_ptr<contact_solver::RestingContacts> resting_;
  std::vector<std::uint8_t> at_rest_; // by particle: does it rest on another one in this kick interval? Empty: none
  std::vector<std::uint64_t> ids_at_rest_;        // on several ranks: the ids of such particles of all ranks, ascending
  std::vector<std::uint32_t> own_by_id_;          // own particles in the order of ids; empty: not known
  std::unique_ptr<decomposition::Blocks> blocks_; // null unless distributed
  std::vector<std::size_t> moonlet_indices_;      // in the store; `elsewhere` on another rank
  std::vector<double> moonlet_wraps_;             // shift in x and y of each by this wrap, m
  TimeSplit split_;
};

} // namespace keeler::simulation

namespace keeler {
using simulation::Simulation;
} // namespace keeler
