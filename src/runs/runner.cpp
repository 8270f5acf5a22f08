#include "runner.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/runs/state_hash.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::runs {
namespace {

constexpr double first_check = 2e-6;         // s per particle: assumed cost of the first force check
constexpr double fraction_of_checks = 0.005; // of the wall time, for force checks; one more runs at the end
constexpr double min_stop_timeout = 5.0;     // s

} // namespace

Runner::Runner(const Scene& scene, const RunOptions& options, RunRequests& requests, Simulation& simulation,
               Recorder& recorder, const Stopwatch& watch, std::int64_t last_checkpoint)
    : scene_(scene), options_(options), requests_(requests), simulation_(simulation), recorder_(recorder),
      watch_(watch), passage_(advice::unresolved_passage(scene, simulation.orbits(), end_orbits(scene))),
      first_step_(simulation.state().step), last_checkpoint_(last_checkpoint),
      first_collisions_(simulation.state().collisions.fast + simulation.state().collisions.slow) {
  requests_.stop_timeout_s = stop_timeout();
  if (options.check)
    check_.emplace(scene, simulation);
  assert(last_checkpoint >= -1 && last_checkpoint <= first_step_);
}

RunResult Runner::run() {
  const simulation::SimulationState& state = simulation_.state();
  observe();
  while (state.step < scene_.time.end_step && !must_stop()) {
    advance();
    record();
    report();
    observe();
  }
  RunResult result;
  result.finished = state.step >= scene_.time.end_step;
  if (result.finished && state.step != recorder_.counters().last_snapshot_step)
    recorder_.snapshot(simulation_);
  if (state.step != last_checkpoint_)
    recorder_.checkpoint(simulation_);
  if (result.finished && has_force_checks() && recorder_.force_checks().last_step != state.step)
    recorder_.check_forces(simulation_);
  result.step = state.step;
  result.state_hash = state_hash(simulation_.state(), scene_, ranks());
  return result;
}

void Runner::advance() {
  const Interruptible step(requests_.give_up);
  if (check_)
    check_->begin();
  simulation_.advance();
  if (check_)
    check_->end();
}

bool Runner::must_stop() const {
  if (!between_kicks())
    return false;
  // two steps more for the last checkpoint
  const double reserve = (steps_between_stops() + 2.0) * longest_step_s_ + recorder_.force_checks().last_s;
  return ranks().broadcast(requests_.stop ||
                           (options_.wall_time_s && watch_.elapsed() + reserve > *options_.wall_time_s));
}

// Reports a passage one orbit ahead, when the satellite begins to pull.
void Runner::report_passage() {
  constexpr double before = 1.0, next = 1e-6; // orbits
  if (!passage_ || simulation_.orbits() < passage_->orbits - before)
    return;
  recorder_.log("satellite passage", {{"orbits", passage_->orbits}, {"drag", passage_->drag}});
  if (options_.notice)
    options_.notice(fmt::format("note: {}", advice::in_words(*passage_)));
  passage_ = advice::unresolved_passage(scene_, passage_->orbits + next, end_orbits(scene_));
}

void Runner::record() {
  const std::int64_t step = simulation_.state().step;
  report_passage();
  recorder_.contacts(simulation_);
  if (due(scene_.output.series_every))
    recorder_.sample(simulation_);
  const bool asked = between_kicks() && ranks().broadcast(requests_.snapshot.exchange(false));
  if (due(scene_.output.snapshot_every) || asked)
    recorder_.snapshot(simulation_);
  if (due(scene_.output.checkpoint_every) || checkpoint_due_by_clock()) {
    recorder_.checkpoint(simulation_);
    last_checkpoint_ = step;
    last_checkpoint_time_ = watch_.elapsed();
  }
  if (force_check_due()) {
    recorder_.check_forces(simulation_);
    last_time_ += recorder_.force_checks().last_s; // not part of a step
  }
}

// The time that the observer takes is not part of a step.
void Runner::observe() {
  if (!options_.observe || !between_kicks())
    return;
  options_.observe(simulation_);
  const double waited = watch_.elapsed() - last_time_;
  last_time_ += waited;
  cost_s_ += waited;
}

bool Runner::checkpoint_due_by_clock() const {
  const double interval = 60.0 * scene_.output.checkpoint_every_minutes;
  return interval > 0.0 && between_kicks() && ranks().broadcast(watch_.elapsed() - last_checkpoint_time_ >= interval);
}

// Force checks take a fixed fraction of the wall time. Their number depends on solver and machine; the state does not
// depend on them.
bool Runner::force_check_due() const {
  const ForceChecks& checks = recorder_.force_checks();
  const double next = checks.count > 0 ? checks.last_s : first_check * static_cast<double>(simulation_.count());
  return has_force_checks() && between_kicks() &&
         ranks().broadcast(checks.seconds + next <= fraction_of_checks * watch_.elapsed());
}

// A step may take up to three times as long as the longest one so far.
unsigned Runner::stop_timeout() const {
  if (!ranks().is_root())
    return 0; // the root decides
  return static_cast<unsigned>(std::ceil(std::max(min_stop_timeout, 3.0 * steps_between_stops() * longest_step_s_)));
}

// Averages the step cost with weights that grow with the third power of the step: steps get slower as wakes grow, and
// the remaining ones will cost as much as the latest.
void Runner::update_step_cost(double now) {
  const std::int64_t step = simulation_.state().step;
  const auto new_steps = static_cast<double>(step - cost_step_), all = static_cast<double>(step - first_step_);
  assert(new_steps > 0.0);
  seconds_per_step_ += std::min(1.0, 4.0 * new_steps / all) * ((now - cost_s_) / new_steps - seconds_per_step_);
  cost_step_ = step;
  cost_s_ = now;
}

void Runner::report() {
  const double now = watch_.elapsed();
  update_step_cost(now);
  longest_step_s_ = std::max(longest_step_s_, now - last_time_);
  requests_.stop_timeout_s = stop_timeout();
  last_time_ = now;
  if (!options_.progress)
    return;
  const simulation::SimulationState& state = simulation_.state();
  RunProgress p;
  p.step = state.step, p.first_step = first_step_, p.end_step = scene_.time.end_step;
  p.orbits = simulation_.orbits(), p.end_orbits = end_orbits(scene_);
  p.elapsed_s = now;
  p.remaining_s = seconds_per_step_ * static_cast<double>(p.end_step - p.step);
  p.collisions_per_second =
      static_cast<double>(state.collisions.fast + state.collisions.slow - first_collisions_) / (now - start_);
  options_.progress(p);
}

} // namespace keeler::runs
