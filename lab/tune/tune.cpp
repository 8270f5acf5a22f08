#include <keeler/tune/tune.hpp>

#include "growth.hpp"
#include "probes.hpp"

#include <keeler/advice/estimate.hpp>
#include <keeler/bench/yardsticks.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace keeler::tune {
namespace {

// Kicks per tenth of an orbit: the intervals divide it, so that outputs fall on the requested times. Consecutive
// intervals differ by a third at most.
constexpr std::array<int, 14> kicks_of_tenth = {100, 80, 64, 50, 40, 32, 25, 20, 16, 12, 10, 8, 6, 5};
constexpr double longest_probe = 0.25;                    // of a kick interval from each state, relative to their age
constexpr double usual_contacts = 0.3;                    // per particle and drift: near the cheapest step
constexpr double min_contacts = 0.04, max_contacts = 1.2; // per particle and drift, of the probed steps
constexpr std::size_t max_direct = 3000;                  // particles
constexpr int gravity_repeats = 3;
constexpr double min_gain = 1.15; // by twice the threads
constexpr double clock_noise = 1.03;

double orbits_of(const Scene& scene) {
  return static_cast<double>(scene.time.end_step) * scene.time.step;
}

bench::GravityChoice choice(const Scene& scene, GravitySettings::Solver solver, std::size_t particles,
                            double parameter) {
  GravitySettings settings;
  settings.solver = solver;
  settings.images = scene.gravity->images;
  settings.resting_contacts = scene.gravity->resting_contacts;
  if (solver == GravitySettings::Solver::tree)
    settings.opening_angle = parameter;
  else if (solver == GravitySettings::Solver::fft)
    settings.force_error = parameter;
  return bench::choice_of(settings, particles);
}

// Returns solvers and settings near the requested error that a scene's keys can express. A finite number of image rings
// is part of the physics, and the mesh cannot represent it.
std::vector<bench::GravityChoice> gravity_candidates(const Scene& scene, std::size_t particles, double force_error) {
  using Solver = GravitySettings::Solver;
  std::vector<bench::GravityChoice> candidates;
  if (particles <= max_direct)
    candidates.push_back(choice(scene, Solver::direct, particles, 0.0));
  for (const double opening_angle : {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9})
    candidates.push_back(choice(scene, Solver::tree, particles, opening_angle));
  if (scene.gravity->images.far)
    for (const double factor : {0.35, 0.5, 0.7, 1.0})
      candidates.push_back(choice(scene, Solver::fft, particles, std::clamp(factor * force_error, 1e-5, 0.1)));
  return candidates;
}

// Chooses the cheapest candidate that meets the tolerance; of equally cheap ones, within the noise of the clock, the
// most accurate. If none meets it, chooses the most accurate.
void choose_gravity(Tuning& tuning, double force_error) {
  const auto error = [&](std::size_t k) { return tuning.gravity[k].errors.rms; };
  const auto cost = [&](std::size_t k) { return tuning.gravity[k].ns_per_particle; };
  assert(!tuning.gravity.empty());
  double min_cost = HUGE_VAL;
  for (std::size_t k = 0; k < tuning.gravity.size(); ++k)
    if (error(k) <= force_error)
      min_cost = std::min(min_cost, cost(k));
  tuning.meets_force_error = min_cost < HUGE_VAL;
  std::size_t best = tuning.gravity.size();
  for (std::size_t k = 0; k < tuning.gravity.size(); ++k) {
    const bool cheap = !tuning.meets_force_error || (error(k) <= force_error && cost(k) <= clock_noise * min_cost);
    if (cheap && (best == tuning.gravity.size() || error(k) < error(best)))
      best = k;
  }
  tuning.chosen_gravity = best;
}

// Returns the power of two of drifts per kick interval with nearly `usual_contacts` per particle and drift.
int usual_drifts(double interval, double contact_rate) {
  const double drifts = interval * contact_rate / usual_contacts;
  return 1 << static_cast<int>(std::lround(std::clamp(std::log2(std::max(1.0, drifts)), 0.0, 9.0)));
}

// Chooses the longest interval that meets the tolerance, by bisection; if none does, the shortest.
void choose_kicks(Tuning& tuning, const Scene& scene, const GrownScene& growth, double physics_error,
                  PhaseProgress& progress) {
  progress.begin("kick intervals", std::ceil(std::log2(kicks_of_tenth.size())));
  std::size_t meeting = 0,
              missing =
                  kicks_of_tenth.size(); // the first `meeting` intervals meet it; intervals from `missing` miss it
  while (meeting < missing) {
    const std::size_t k = (meeting + missing) / 2;
    const double interval = 0.1 / kicks_of_tenth[k];
    tuning.kicks.push_back(probe_kicks(scene, growth.states, interval, usual_drifts(interval, growth.contact_rate),
                                       longest_probe * growth.orbits));
    progress.add(1.0);
    const bool meets = tuning.kicks.back().physics_error() <= physics_error;
    if (meets || k == 0)
      tuning.chosen_kicks = tuning.kicks.size() - 1;
    (meets ? meeting : missing) = meets ? k + 1 : k;
  }
  tuning.meets_physics_error = meeting > 0;
}

// Returns the probed numbers of drifts per kick interval, powers of two.
std::vector<int> drift_candidates(double interval, double contact_rate) {
  std::vector<int> candidates;
  for (int drifts = 1; drifts <= 512; drifts *= 2)
    if (const double contacts = interval * contact_rate / drifts; contacts >= min_contacts && contacts <= max_contacts)
      candidates.push_back(drifts);
  if (candidates.empty())
    candidates.push_back(usual_drifts(interval, contact_rate));
  return candidates;
}

// Returns the index of the cheapest step; of equally cheap ones, within the noise of the clock, the longest.
// Precondition: `steps` is not empty and begins with the longest step.
std::size_t cheapest_step(const std::vector<StepProbe>& steps) {
  assert(!steps.empty() && steps.front().step >= steps.back().step);
  double min_seconds = steps.front().seconds;
  for (const StepProbe& probe : steps)
    min_seconds = std::min(min_seconds, probe.seconds);
  std::size_t best = 0;
  while (steps[best].seconds > clock_noise * min_seconds)
    ++best;
  return best;
}

void choose_step(Tuning& tuning, const Scene& scene, const GrownScene& growth, double interval,
                 PhaseProgress& progress) {
  tuning.steps = probe_steps(scene, growth.states, interval, drift_candidates(interval, growth.contact_rate), progress);
  tuning.chosen_step = cheapest_step(tuning.steps);
}

void choose_threads(Tuning& tuning) {
  ThreadProbe best = tuning.threads.front();
  for (const ThreadProbe& probe : tuning.threads)
    if (probe.speedup >= min_gain * best.speedup)
      best = probe;
  tuning.chosen_threads = best.threads;
}

// Predicts the duration of the run. Up to the probed state it scales the measured duration of the evolution by the
// ratio of the costs per orbit at its end: chosen settings over the settings of the evolution.
void predict(Tuning& tuning, const Scene& scene, const GrownScene& growth) {
  assert(growth.orbits > 0.0 && growth.seconds_at_end > 0.0);
  const double per_orbit = tuning.steps[tuning.chosen_step].seconds, whole = orbits_of(scene);
  const double until_probed = std::min(1.0, whole / growth.orbits) * growth.seconds * per_orbit / growth.seconds_at_end;
  const double steps = until_probed + std::max(0.0, whole - growth.orbits) * per_orbit;
  double files = 0.0;
  if (!scene.start_from) {
    const advice::RunEstimate estimate = advice::estimate_run(scene, bench::pair_yardstick(bench::bench_seconds));
    files = estimate.start + estimate.output;
  }
  double speedup = 1.0;
  for (const ThreadProbe& probe : tuning.threads)
    if (probe.threads == tuning.chosen_threads)
      speedup = probe.speedup;
  tuning.processor_seconds = steps + files;
  tuning.wall_seconds = steps / speedup + files;
}

// Sets one thread during its lifetime: other work on the machine affects its processor time least.
class OneThread {
public:
  OneThread() { set_threads(1); }
  ~OneThread() { set_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

private:
  int before_ = threads();
};

} // namespace

Tuning tune(const Scene& scene, const TuneSettings& settings) {
  if (scene.gravity && !scene.gravity->by_pairs())
    throw UsageError("the scene's gravity is axisymmetric, which has one solver only; choose the step with \"keeler "
                     "study step\", or use another gravity.solver");
  assert(settings.force_error > 0.0 && settings.physics_error > 0.0 && settings.max_threads > 0);
  PhaseProgress progress(settings.progress);
  const double usual = scene.gravity ? 4.0 : 8.0; // after the overshoot of the wakes
  const GrownScene growth = grow(scene, std::min(settings.orbits.value_or(usual), orbits_of(scene)), progress);
  const OneThread measured;
  Tuning tuning;
  tuning.particles = growth.states.back().size();
  tuning.orbits = growth.orbits;
  Scene chosen = growth.scene;
  double interval = 0.1 / kicks_of_tenth.back();
  if (scene.gravity) {
    tuning.gravity =
        bench_gravity_of(growth.states.back(), gravity_candidates(growth.scene, tuning.particles, settings.force_error),
                         gravity_repeats, progress)
            .rows;
    choose_gravity(tuning, margin_for_seeds * settings.force_error);
    chosen.gravity = tuning.gravity[tuning.chosen_gravity].choice.settings;
    choose_kicks(tuning, chosen, growth, margin_for_seeds * settings.physics_error, progress);
    interval = tuning.kicks[tuning.chosen_kicks].interval;
  }
  choose_step(tuning, chosen, growth, interval, progress);
  const StepProbe& step = tuning.steps[tuning.chosen_step];
  chosen = with_steps(chosen, step.step, step.drifts);
  tuning.threads = probe_threads(chosen, growth.states.back(), settings.max_threads, progress);
  choose_threads(tuning);
  predict(tuning, scene, growth);
  return tuning;
}

} // namespace keeler::tune
