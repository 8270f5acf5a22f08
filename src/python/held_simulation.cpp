#include "held_simulation.hpp"

#include "computing.hpp"

#include <keeler/core/stopwatch.hpp>

#include <fmt/format.h>

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

// Keeps the page from reading the state during its lifetime. Precondition: the caller holds Busy.
class HeldSimulation::Withdrawn {
public:
  explicit Withdrawn(const HeldSimulation& held) : held_(held) {
    if (held_.view_)
      held_.view_->withdraw();
  }
  ~Withdrawn() {
    if (held_.view_ && !held_.broken())
      held_.view_->offer(*held_.simulation_, held_.scene_);
  }
  Withdrawn(const Withdrawn&) = delete;
  Withdrawn& operator=(const Withdrawn&) = delete;

private:
  const HeldSimulation& held_;
};

HeldSimulation::~HeldSimulation() {
  view_.reset();
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
    return simulation_->state().step % interval == 0 &&
           (keyboard.stop() || watch.elapsed() > between_signals || stop_asked_ || (view_ && view_->holds()));
  };
  try {
    do {
      simulation_->advance();
      if (view_ && simulation_->state().step % interval == 0)
        view_->at_boundary(*simulation_, scene_);
    } while (simulation_->state().step < until_tick && !must_return());
  } catch (const InvariantError& error) {
    broken_ = error;
    throw;
  }
}

// Waits while a page has paused or slowed the run.
void HeldSimulation::wait_for_view() {
  for (bool may_step = !view_; !may_step;) {
    {
      const Keyboard keyboard;
      const Unlocked unlocked;
      double elapsed = 0.0;
      const Stopwatch watch(elapsed);
      may_step = view_->wait(*simulation_, scene_,
                             [&] { return keyboard.stop() || stop_asked_ || watch.elapsed() > between_signals; });
    }
    raise_interrupts();
    raise_stop();
  }
}

// A page that stops a run does what Ctrl-C does.
void HeldSimulation::raise_stop() {
  if (!stop_asked_.exchange(false))
    return;
  PyErr_SetString(PyExc_KeyboardInterrupt, "stopped from the view");
  throw pybind11::error_already_set();
}

std::string HeldSimulation::open_view(const std::string& title, int port) {
  whole_state();
  const Busy here(busy_);
  if (!view_ || !view_->is_open()) {
    view_ = std::make_unique<live_view::LiveView>(live_view::ViewOptions{.title = title,
                                                                         .path = {},
                                                                         .port = port,
                                                                         .stop = [this] { stop_asked_ = true; },
                                                                         .stage = live_view::Stage::idle});
    view_->offer(*simulation_, scene_);
  }
  return view_->address();
}

void HeldSimulation::close_view() {
  if (view_)
    view_->close();
}

void HeldSimulation::advance(std::int64_t until_tick) {
  whole_state();
  const Busy here(busy_);
  require_own_threads();
  stop_asked_ = false;
  const Withdrawn from_the_page(*this);
  detach_views();
  simulation::SimulationState before;
  while (simulation_->state().step < until_tick) {
    wait_for_view();
    try {
      change(before, [&] { step_until(until_tick); });
    } catch (const InvariantError&) {
      throw;
    } catch (...) { // an interrupt, no memory, a restitution law without a valid coefficient
      raise_interrupts();
      throw;
    }
    raise_interrupts();
    raise_stop();
  }
}

void HeldSimulation::replace(Particles particles) {
  whole_state();
  const Busy here(busy_);
  require_own_threads();
  const Withdrawn from_the_page(*this);
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
