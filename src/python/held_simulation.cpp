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

void HeldSimulation::require_idle() const {
  if (at_work_)
    refuse_at_work();
}

const Simulation& HeldSimulation::simulation() const {
  require_idle();
  return *simulation_;
}

const SimulationState& HeldSimulation::whole_state() const {
  const SimulationState& state = simulation().state();
  if (broken())
    throw Error(ExitCode::run_time,
                fmt::format("this simulation cannot go on (an invariant broke: {}); look at its "
                            "state with snapshot(), load the last one that was saved, or begin again",
                            broken_->what()));
  return state;
}

// Leaves the state to arrays that look at it, and goes on with a simulation made of a copy; likewise where the present
// one cannot go on. All that may fail comes first.
void HeldSimulation::make_way() {
  if (keep_.use_count() == 1 && !put_back_)
    return;
  auto keep = std::make_shared<Keep>();
  auto next = std::make_unique<Simulation>(scene_, simulation_->state());
  static_assert(std::is_nothrow_move_constructible_v<SimulationState>);
  if (keep_.use_count() > 1)
    keep_->state.emplace(std::move(*simulation_).take_state());
  keep_ = std::move(keep);
  simulation_ = std::move(next);
  put_back_ = false;
  if (recorder_)
    recorder_->watch(*simulation_);
}

// Calls change(); where it throws, the state and the contacts that were recorded are those of before, unless an
// invariant broke. `before` is memory for the copy.
template<class Change> void HeldSimulation::change(SimulationState& before, const Change& change) {
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
  const AtWork here(at_work_);
  require_own_threads();
  make_way();
  SimulationState before;
  while (simulation_->state().step < until_tick) {
    try {
      change(before, [&] { step_until(until_tick); });
    } catch (const InvariantError&) {
      throw;
    } catch (...) { // an interrupt, no memory, a law that gives no coefficient
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
  make_way();
  SimulationState before;
  change(before, [&] {
    const Unlocked unlocked;
    simulation_->replace(std::move(particles));
  });
}

void HeldSimulation::record_contacts(std::optional<double> minimum_speed) {
  require_idle();
  std::unique_ptr<ContactRecorder> next;
  if (minimum_speed) {
    whole_state(); // recording ends in any state
    next = std::make_unique<ContactRecorder>(*minimum_speed, scene_.planet.orbital_frequency);
  }
  simulation_->drift().observe(nullptr);
  recorder_ = std::move(next);
  if (recorder_)
    recorder_->watch(*simulation_);
}

} // namespace keeler::python
