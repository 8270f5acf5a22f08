#include "held_simulation.hpp"

#include "computing.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>

#include <fmt/format.h>

namespace keeler::python {
namespace {

constexpr double between_signals = 0.2; // s: the interpreter's handlers of other signals wait no longer

[[noreturn]] void refuse_at_work() {
  throw Error(ExitCode::run_time,
              "this simulation is at work, in another thread or below this call; wait for it, or use a second one");
}

} // namespace

// Who computes; a second thread is told.
class HeldSimulation::AtWork {
public:
  explicit AtWork(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true))
      refuse_at_work();
  }
  ~AtWork() { flag_ = false; }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

private:
  std::atomic<bool>& flag_;
};

HeldSimulation::~HeldSimulation() {
  if (simulation_ && keep_.use_count() > 1)
    keep_->state = std::move(*simulation_).take_state();
}

const Simulation& HeldSimulation::simulation() const {
  if (at_work_)
    refuse_at_work();
  if (given_up_)
    throw Error(ExitCode::run_time,
                "a step of this simulation was given up, and its state with it; load the last one that was saved, or "
                "begin again");
  return *simulation_;
}

const SimulationState& HeldSimulation::whole_state() const {
  const SimulationState& state = simulation().state();
  if (broken())
    throw Error(ExitCode::run_time,
                fmt::format("this simulation cannot go on (an invariant broke: {}); look at its "
                            "state with snapshot(), load the last one that was saved, or begin again",
                            broken_));
  return state;
}

void HeldSimulation::make_way_for_views() {
  if (keep_.use_count() == 1)
    return;
  SimulationState copy = simulation_->state();
  keep_->state = std::move(*simulation_).take_state();
  keep_ = std::make_shared<Keep>();
  simulation_ = std::make_unique<Simulation>(scene_, std::move(copy));
  if (recorder_)
    recorder_->watch(*simulation_);
}

void HeldSimulation::step_until(std::int64_t until_tick) {
  const Keyboard keyboard;
  const Interruptible by_keyboard(keyboard.give_up());
  const pybind11::gil_scoped_release unlocked;
  const std::int64_t interval = scene_.kick_interval();
  double elapsed = 0.0;
  const Stopwatch watch(elapsed);
  const auto must_return = [&] {
    return simulation_->state().step % interval == 0 && (keyboard.stop() || watch.elapsed() > between_signals);
  };
  do
    simulation_->advance();
  while (simulation_->state().step < until_tick && !must_return());
}

void HeldSimulation::advance(std::int64_t until_tick) {
  whole_state();
  const AtWork here(at_work_);
  require_own_threads();
  make_way_for_views();
  while (simulation_->state().step < until_tick) {
    try {
      step_until(until_tick);
    } catch (const InvariantError& error) {
      broken_ = error.what();
      throw;
    } catch (...) { // an unfinished step: interrupted, or there is no memory
      given_up_ = true;
      raise_interrupts();
      throw;
    }
    raise_interrupts();
  }
}

void HeldSimulation::replace(Particles particles) {
  whole_state();
  const AtWork here(at_work_);
  require_own_threads();
  make_way_for_views();
  const pybind11::gil_scoped_release unlocked;
  simulation_->replace(std::move(particles));
}

void HeldSimulation::record_contacts(std::optional<double> minimum_speed) {
  if (at_work_)
    refuse_at_work();
  if (minimum_speed)
    whole_state(); // recording ends in any state
  simulation_->drift().observe(nullptr);
  recorder_.reset();
  if (!minimum_speed)
    return;
  recorder_ = std::make_unique<ContactRecorder>(*minimum_speed, scene_.planet.orbital_frequency);
  recorder_->watch(*simulation_);
}

std::vector<ContactRecord> HeldSimulation::take_contacts() {
  if (at_work_)
    refuse_at_work();
  return recorder_ ? recorder_->take() : std::vector<ContactRecord>();
}

} // namespace keeler::python
