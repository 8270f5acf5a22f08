// The step: kick–drift–kick. Gravity's half kick, a drift with its collisions, gravity's half kick; the kicks only
// every k-th drift, and none at all in a scene without gravity.
#pragma once

#include <keeler/gravity/solver.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/state.hpp>

#include <memory>

namespace keeler {

/// Wall time spent in each part since construction, s.
struct TimeSplit {
  double drift = 0.0;
  double advance = 0.0; ///< of the drift: to the next epoch and back into the cell
  double gravity = 0.0;
  double kick = 0.0; ///< of gravity: the half kicks
};

class Simulation {
public:
  /// A new run from a patch; time starts at zero. Throws InvariantError when particles overlap by more than rounding.
  Simulation(const Scene& scene, const Patch& start);

  /// A run that goes on from a state, to the bit.
  Simulation(const Scene& scene, SimulationState state);

  /// One step. Throws InvariantError, or Interrupted when an Interruptible (interrupt.hpp) asks for it; the state is
  /// then that of an unfinished step and must not be stored.
  void advance();

  const SimulationState& state() const { return state_; }
  double orbits() const { return static_cast<double>(state_.step) * scene_.time.step; }

  /// A Cartesian copy of the present state.
  Patch patch() const;

  /// What the gravity solver is asked at this boundary between steps, in the order of state().particles. The two arrays
  /// are filled, and must outlive it.
  GravityProblem gravity_problem(std::vector<Vec3>& positions, std::vector<double>& masses) const;

  /// Energy now − start − all that was booked: zero up to rounding. In kg m² rad⁻².
  double energy_residual() const;

  const TimeSplit& time_split() const { return split_; }

  /// To watch collisions, or to measure finders.
  DriftPhase& drift() { return drift_; }

private:
  void accelerate();
  Vec3 random_origin() const;
  void half_kick();
  void move_on();
  void sort_when_due();
  bool kick_due() const { return solver_ && state_.step % scene_.gravity->kick_every == 0; }

  Scene scene_;
  SimulationState state_;
  DriftPhase drift_;
  std::unique_ptr<GravitySolver> solver_;
  TimeSplit split_;
  // scratch of the gravity solve
  std::vector<Vec3> positions_;
  std::vector<double> masses_;
};

} // namespace keeler
