// A simulation that Python holds: it computes without the interpreter's lock, heeds the keyboard, and keeps what Python
// looks at as it was.
#pragma once

#include "contact_record.hpp"

#include <keeler/core/error.hpp>
#include <keeler/simulation/simulation.hpp>

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace keeler::python {

/// Arrays on the state hold a share of its Keep. When the simulation moves on and somebody has such a share, the state
/// is left to them as it is, and the simulation goes on with a copy.
struct Keep {
  std::optional<SimulationState> state; ///< once the simulation has left it
};

class HeldSimulation {
public:
  HeldSimulation(const Scene& scene, std::unique_ptr<Simulation> simulation)
      : scene_(scene), simulation_(std::move(simulation)) {}
  ~HeldSimulation();
  HeldSimulation(const HeldSimulation&) = delete;
  HeldSimulation& operator=(const HeldSimulation&) = delete;

  const Scene& scene() const { return scene_; }

  /// To be looked at. Throws Error (run_time) when it is at work in another thread.
  const Simulation& simulation() const;
  const SimulationState& state() const { return simulation().state(); }

  /// Of a simulation that can go on. Throws Error (run_time) where none can: see simulation(), or an invariant broke.
  const SimulationState& whole_state() const;

  /// An invariant broke in a step: the state stands at Simulation::time_at_break(), and can be looked at.
  bool broken() const { return broken_.has_value(); }

  /// Steps until that tick, a multiple of the scene's kick interval. Interrupts are raised at the next such multiple;
  /// a second one gives up the steps at hand. Whatever it throws but InvariantError, the state is that of a multiple
  /// from before: of the call, or of at most 0.2 s of computing ago.
  void advance(std::int64_t until_tick);

  /// For arrays on the state.
  std::shared_ptr<Keep> keep() const { return keep_; }

  /// The state is as before where it throws.
  void replace(Particles particles);

  /// Contacts are recorded from now on, those at least as fast (m/s); none: they are not.
  void record_contacts(std::optional<double> minimum_speed);
  /// Hands those of since the last call to take(rows), and forgets them unless that throws.
  template<class Take> auto take_contacts(const Take& take) {
    require_idle();
    if (!recorder_)
      return take(std::vector<ContactRecord>());
    auto taken = take(recorder_->rows());
    recorder_->clear();
    return taken;
  }

private:
  class AtWork;
  void require_idle() const;
  void make_way();
  void step_until(std::int64_t until_tick);
  template<class Change> void change(SimulationState& before, const Change& change);

  Scene scene_;
  std::shared_ptr<Keep> keep_ = std::make_shared<Keep>();
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<ContactRecorder> recorder_;
  std::atomic<bool> at_work_ = false;
  bool put_back_ = false;                // the simulation can only be looked at
  std::optional<InvariantError> broken_; // why
};

} // namespace keeler::python
