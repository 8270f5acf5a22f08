#include "runner.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/runs/state_hash.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {
namespace {

constexpr double first_check = 5e-6;         // s a particle: what a check is taken to cost before there was one
constexpr double fraction_of_checks = 0.005; // of the wall time, for the errors of forces; one at the end besides
constexpr double min_patience = 5.0;         // s, with a stop

} // namespace

Runner::Runner(const Scene& scene, const RunOptions& options, RunRequests& requests, Simulation& simulation,
               Recorder& recorder, const Stopwatch& watch, std::int64_t last_checkpoint)
    : scene_(scene), options_(options), requests_(requests), simulation_(simulation), recorder_(recorder),
      watch_(watch), passage_(unresolved_passage(scene, simulation.orbits(), end_orbits(scene))),
      first_step_(simulation.state().step), last_checkpoint_(last_checkpoint),
      first_collisions_(simulation.state().collisions.fast + simulation.state().collisions.slow) {
  requests_.patience_s = patience();
  if (options.check)
    check_.emplace(scene, simulation);
  assert(!check_ || !simulation.ranks().distributed());
}

RunResult Runner::run() {
  const SimulationState& state = simulation_.state();
  while (state.step < scene_.time.end_step && !must_stop()) {
    advance();
    record();
    report();
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
  // two passes more for the last checkpoint
  const double reserve = (passes_between_stops() + 2.0) * longest_pass_ + recorder_.force_checks().last_s;
  return ranks().broadcast(requests_.stop ||
                           (options_.wall_time_s && watch_.elapsed() + reserve > *options_.wall_time_s));
}

// An orbit before, when the satellite begins to pull.
void Runner::tell_of_passage() {
  constexpr double before = 1.0, next = 1e-6; // orbits
  if (!passage_ || simulation_.orbits() < passage_->orbits - before)
    return;
  recorder_.log("satellite passage", {{"orbits", passage_->orbits}, {"drag", passage_->drag}});
  if (options_.notice)
    options_.notice(fmt::format("note: {}", in_words(*passage_)));
  passage_ = unresolved_passage(scene_, passage_->orbits + next, end_orbits(scene_));
}

void Runner::record() {
  const std::int64_t step = simulation_.state().step;
  tell_of_passage();
  recorder_.contacts();
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
    last_time_ += recorder_.force_checks().last_s; // not what a step takes
  }
}

bool Runner::checkpoint_due_by_clock() const {
  const double interval = 60.0 * scene_.output.checkpoint_every_minutes;
  return interval > 0.0 && between_kicks() && ranks().broadcast(watch_.elapsed() - last_checkpoint_time_ >= interval);
}

// As often as a small share of the time allows: that is another number of steps for each solver and machine, and no
// state hangs on it.
bool Runner::force_check_due() const {
  const ForceChecks& checks = recorder_.force_checks();
  const double next = checks.count > 0 ? checks.last_s : first_check * static_cast<double>(simulation_.count());
  return has_force_checks() && between_kicks() && checks.seconds + next <= fraction_of_checks * watch_.elapsed();
}

// Three times as long as any pass so far is nothing unusual.
unsigned Runner::patience() const {
  if (!ranks().is_root())
    return 0; // it decides
  return static_cast<unsigned>(std::ceil(std::max(min_patience, 3.0 * passes_between_stops() * longest_pass_)));
}

// A mean over the steps so far whose weights grow with the third power of the step: steps get dearer as wakes grow,
// and what is left will cost what the last ones did.
void Runner::take_pace(double now) {
  const std::int64_t step = simulation_.state().step;
  const auto new_steps = static_cast<double>(step - paced_step_), all = static_cast<double>(step - first_step_);
  seconds_per_step_ += std::min(1.0, 4.0 * new_steps / all) * ((now - paced_s_) / new_steps - seconds_per_step_);
  paced_step_ = step;
  paced_s_ = now;
}

void Runner::report() {
  const double now = watch_.elapsed();
  take_pace(now);
  longest_pass_ = std::max(longest_pass_, now - last_time_);
  requests_.patience_s = patience();
  last_time_ = now;
  if (!options_.progress)
    return;
  const SimulationState& state = simulation_.state();
  RunProgress p;
  p.step = state.step, p.first_step = first_step_, p.end_step = scene_.time.end_step;
  p.orbits = simulation_.orbits(), p.end_orbits = end_orbits(scene_);
  p.elapsed_s = now;
  p.remaining_s = seconds_per_step_ * static_cast<double>(p.end_step - p.step);
  p.collisions_per_second =
      static_cast<double>(state.collisions.fast + state.collisions.slow - first_collisions_) / (now - start_);
  options_.progress(p);
}

} // namespace keeler
