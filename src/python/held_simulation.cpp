#include "held_simulation.hpp"

#include "computing.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::python {
namespace {

constexpr double between_signals = 0.2; // s: longest delay of the interpreter's handlers of other signals

[[noreturn]] void refuse_busy() {
  throw Error(ExitCode::run_time,
              "this simulation is computing, in another thread or below this call; wait for it, or use a second one");
}

} // namespace

// Marks the simulation as busy during its lifetime. Throws Error (run_time) in a second thread.
class HeldSimulation::Busy {
public:
  explicit Busy(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true))
      refuse_busy();
  }
  ~Busy() { flag_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

private:
  std::atomic<bool>& flag_;
};

HeldSimulation::~HeldSimulation() {
  if (simulation_ && viewed_state_.use_count() > 1)
    viewed_state_->state = std::move(*simulation_).take_state();
}

void HeldSimulation::require_idle() const {
  if (busy_)
    refuse_busy();
}

const Simulation& HeldSimulation::simulation() const {
  require_idle();
  return *simulation_;
}

const simulation::SimulationState& HeldSimulation::whole_state() const {
  const simulation::SimulationState& state = simulation().state();
  if (broken())
    throw Error(ExitCode::run_time,
                fmt::format("this simulation cannot go on (an invariant broke: {}); inspect its state with snapshot(), "
                            "load the last saved state, or start again",
                            broken_->what()));
  return state;
}

// If arrays view the state, leaves it to them and continues with a simulation made of a copy; likewise if the present
// simulation cannot continue. All steps that may fail come first.
void HeldSimulation::detach_views() {
  if (viewed_state_.use_count() == 1 && !put_back_)
    return;
  auto viewed = std::make_shared<ViewedState>();
  auto next = std::make_unique<Simulation>(scene_, simulation_->state());
  static_assert(std::is_nothrow_move_constructible_v<simulation::SimulationState>);
  if (viewed_state_.use_count() > 1)
    viewed_state_->state.emplace(std::move(*simulation_).take_state());
  viewed_state_ = std::move(viewed);
  simulation_ = std::move(next);
  put_back_ = false;
  if (recorder_)
    recorder_->watch(*simulation_);
}

// Calls change(). If it throws, restores the state and the recorded contacts, unless an invariant broke. `before` is
// the memory for the copy.
template<class Change> void HeldSimulation::change(simulation::SimulationState& before, const Change& change) {
  const std::size_t contacts = recorder_ ? recorder_->rows().size() : 0;
  {
    const Unlocked unlocked;
    before = simulation_->state();
  }
  try {
    change();
  } catch (...) {
    if (!broken_) {
      simulation_->put_back(std::move(before));
      put_back_ = true;
      if (recorder_)
        recorder_->keep_first(contacts);
    }
    throw;
  }
}

void HeldSimulation::step_until(std::int64_t until_tick) {
  const Keyboard keyboard;
  const Interruptible by_keyboard(keyboard.give_up());
  const Unlocked unlocked;
  const std::int64_t interval = scene_.kick_interval();
  assert(interval > 0 && until_tick % interval == 0);
  double elapsed = 0.0;
  const Stopwatch watch(elapsed);
  const auto must_return = [&] {
    return simulation_->state().step % interval == 0 && (keyboard.stop() || watch.elapsed() > between_signals);
  };
  try {
    do
      simulation_->advance();
    while (simulation_->state().step < until_tick && !must_return());
  } catch (const InvariantError& error) {
    broken_ = error;
    throw;
  }
}

void HeldSimulation::advance(std::int64_t until_tick) {
  whole_state();
  const Busy here(busy_);
  require_own_threads();
  detach_views();
  simulation::SimulationState before;
  while (simulation_->state().step < until_tick) {
    try {
      change(before, [&] { step_until(until_tick); });
    } catch (const InvariantError&) {
      throw;
    } catch (...) { // an interrupt, no memory, a restitution law without a valid coefficient
      raise_interrupts();
      throw;
    }
    raise_interrupts();
  }
}

void HeldSimulation::replace(Particles particles) {
  whole_state();
  const Busy here(busy_);
  require_own_threads();
  detach_views();
  simulation::SimulationState before;
  change(before, [&] {
    const Unlocked unlocked;
    simulation_->replace(std::move(particles));
  });
}

void HeldSimulation::record_contacts(std::optional<double> minimum_speed) {
  require_idle();
  std::unique_ptr<ContactRecorder> next;
  if (minimum_speed) {
    whole_state(); // required to begin recording; it can end in any state
    next = std::make_unique<ContactRecorder>(*minimum_speed, scene_.planet.orbital_frequency);
  }
  simulation_->drift().observe(nullptr);
  recorder_ = std::move(next);
  if (recorder_)
    recorder_->watch(*simulation_);
}

} // namespace keeler::python
