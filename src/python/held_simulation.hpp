// A simulation owned by Python: it computes without the interpreter's lock, can be interrupted from the keyboard, and
// never changes a state that numpy arrays view.
#pragma once

#include "contact_record.hpp"

#include <keeler/core/error.hpp>
#include <keeler/live_view/live_view.hpp>
#include <keeler/simulation/simulation.hpp>

#include <pybind11/pybind11.h>

#include <atomic>
#include <cassert>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace keeler::python {

/// The owner of the memory that numpy arrays view; the arrays share it. When the simulation continues while such arrays
/// exist, it leaves its state to them and continues with a copy.
struct ViewedState {
  std::optional<simulation::SimulationState> state; ///< after the simulation has left it
};

class HeldSimulation {
public:
  /// Precondition: `simulation` is not null and is of this scene.
  HeldSimulation(const Scene& scene, std::unique_ptr<Simulation> simulation)
      : scene_(scene), simulation_(std::move(simulation)) {
    assert(simulation_);
  }
  ~HeldSimulation();
  HeldSimulation(const HeldSimulation&) = delete;
  HeldSimulation& operator=(const HeldSimulation&) = delete;

  const Scene& scene() const { return scene_; }

  /// Returns the simulation for reading. Throws Error (run_time) while another thread computes with it.
  const Simulation& simulation() const;
  const simulation::SimulationState& state() const { return simulation().state(); }

  /// Returns the state of a simulation that can continue. Throws Error (run_time) as simulation() does, and after a
  /// broken invariant.
  const simulation::SimulationState& whole_state() const;

  /// True if an invariant broke in a step; the state is then at Simulation::time_at_break(), and can be read.
  bool broken() const { return broken_.has_value(); }

  /// Advances to a tick. Interrupts are raised at the next multiple of the kick interval; a second one gives up the
  /// current steps. After any exception except InvariantError the state is at an earlier multiple: that of the call, or
  /// at most 0.2 s of computing ago. Precondition: `until_tick` is a multiple of the scene's kick interval.
  void advance(std::int64_t until_tick);

  /// Returns the owner for arrays that view the state.
  std::shared_ptr<ViewedState> viewed_state() const { return viewed_state_; }

  /// Replaces the particles. If it throws, the state is unchanged.
  void replace(Particles particles);

  /// Shows the simulation in a page, and returns its address; of the open one, if there is one. Throws Error.
  std::string open_view(const std::string& title, int port);
  /// Ends the page, if there is one, from any thread; a run that it has paused goes on.
  void close_view();

  /// Records contacts of at least this normal speed (m/s) from now on; none: stops recording.
  void record_contacts(std::optional<double> minimum_speed);
  /// Calls take(rows) with the contacts since the last call, and drops them unless it throws.
  template<class Take> auto take_contacts(const Take& take) {
    require_idle();
    if (!recorder_)
      return take(std::vector<ContactRecord>());
    auto taken = take(recorder_->rows());
    recorder_->clear();
    return taken;
  }

private:
  class Busy;
  class Withdrawn;
  void require_idle() const;
  void detach_views();
  void step_until(std::int64_t until_tick);
  void wait_for_view();
  void raise_stop();
  template<class Change> void change(simulation::SimulationState& before, const Change& change);

  Scene scene_;
  std::shared_ptr<ViewedState> viewed_state_ = std::make_shared<ViewedState>();
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<ContactRecorder> recorder_;
  std::atomic<bool> busy_ = false;
  bool put_back_ = false;                // the state was restored: the simulation can only be read
  std::optional<InvariantError> broken_; // the broken invariant
  std::unique_ptr<live_view::LiveView> view_;
  std::atomic<bool> stop_asked_ = false; // by a page
};

} // namespace keeler::python
