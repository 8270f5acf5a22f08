#include <keeler/states/clumped.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/wakes.hpp>
#include <keeler/simulation/simulation.hpp>
#include <keeler/states/initial.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

Wakes wakes_of(const Patch& patch) {
  return find_wakes(mean_autocorrelation(std::span(&patch, 1)), critical_wavelength(patch));
}

void require_gravity(const Scene& scene) {
  if (!scene.gravity)
    throw UsageError("the scene has no [gravity] (only their own gravity clumps particles); add [gravity] to it");
}

void require_visible_wakes(const Patch& patch) {
  if (patch.size() == 0 || wakes_of(patch).profile.empty())
    throw UsageError(fmt::format("wakes could not be seen in this patch ({} particles; lambda_cr, {:.3g} m, spans too "
                                 "few of them); take more particles, a higher optical depth or a larger box",
                                 patch.size(), patch.size() ? critical_wavelength(patch) : 0.0));
}

// A whole number of kick intervals: within one the closing half kick is missing.
std::int64_t steps_between_samples(const Scene& scene, const SettleCriterion& criterion) {
  const std::int64_t kicks = scene.kick_interval();
  const double interval = static_cast<double>(kicks) * scene.time.step;
  return kicks * std::max(1L, std::lround(1.0 / (criterion.samples_per_orbit * interval)));
}

[[noreturn]] void fail_unsettled(const Clumping& c, const Patch& patch) {
  const Settling& s = c.settling;
  if (!s.standing)
    throw Error(ExitCode::run_time,
                fmt::format("no wakes stand in the patch after {:.3g} orbits (autocorrelation amplitude {:.2g}): it is "
                            "too light or too hot to clump (Toomre's Q is {:.3g}); raise the optical depth or the "
                            "density of the particles",
                            c.orbits, s.amplitude, toomre_q(patch)));
  throw Error(ExitCode::run_time,
              fmt::format("the wakes did not settle in {:.3g} orbits (autocorrelation amplitude {:.3g} over the last "
                          "orbit, {:.3g} over the one before: a change of {:.0f} %, settled is {:g} %); take a larger "
                          "box, whose mean scatters less, or a snapshot of a run",
                          c.orbits, s.amplitude, s.before, 100.0 * s.change, 100.0 * c.criterion.largest_change));
}

} // namespace

ClumpedState clumped_state(const Scene& scene, const std::function<void(const ClumpingProgress&)>& progress) {
  require_gravity(scene);
  double seconds = 0.0;
  const Stopwatch watch(seconds);
  Simulation simulation(scene, initial_patch(scene));
  require_visible_wakes(simulation.patch());

  Clumping clumping;
  const std::int64_t every = steps_between_samples(scene, clumping.criterion);
  clumping.sample_every_orbits = static_cast<double>(every) * scene.time.step;
  const auto window = static_cast<std::size_t>(
      std::max(1L, std::lround(clumping.criterion.window_orbits / clumping.sample_every_orbits)));
  ClumpingProgress p;
  p.criterion = clumping.criterion;
  for (;;) {
    simulation.advance();
    p.orbits = clumping.orbits = simulation.orbits();
    const bool sample = simulation.state().step % every == 0;
    if (sample) {
      const Wakes wakes = wakes_of(simulation.patch());
      p.amplitude = wakes.amplitude;
      clumping.history.push_back({p.orbits, wakes.amplitude, wakes.pitch_degrees.has_value()});
      p.settling = compare_windows(clumping.history, window);
      p.settled = p.settling && settled(*p.settling, clumping.criterion);
      clumping.settling = p.settling.value_or(Settling{});
    }
    p.elapsed_s = watch.elapsed();
    if (progress)
      progress(p);
    if (p.settled)
      return {simulation.patch(), clumping};
    if (sample && p.orbits >= clumping.criterion.most_orbits)
      fail_unsettled(clumping, simulation.patch());
  }
}

std::map<std::string, std::vector<double>> clumping_numbers(const Clumping& clumping) {
  std::map<std::string, std::vector<double>> numbers = {
      {"orbits", {clumping.orbits}},
      {"amplitude", {clumping.settling.amplitude}},
      {"amplitude_before", {clumping.settling.before}},
      {"change", {clumping.settling.change}},
      {"largest_change", {clumping.criterion.largest_change}},
      {"deviation", {clumping.settling.deviation}},
      {"largest_deviation", {clumping.criterion.largest_deviation}},
      {"window_orbits", {clumping.criterion.window_orbits}},
      {"most_orbits", {clumping.criterion.most_orbits}},
      {"sample_every_orbits", {clumping.sample_every_orbits}},
  };
  for (const WakeSample& sample : clumping.history) {
    numbers["history_orbits"].push_back(sample.orbits);
    numbers["history_amplitude"].push_back(sample.amplitude);
  }
  return numbers;
}

} // namespace keeler
