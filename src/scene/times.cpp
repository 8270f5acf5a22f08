#include "times.hpp"

#include <keeler/core/format.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace keeler::scene {
namespace {

// Returns a time in ticks: the nearest multiple of the kick interval, at least one unless the time is 0.
std::int64_t whole_kicks(Scene& scene, config::Settings& settings, const std::string& key) {
  const double orbits = settings.number(key);
  const std::int64_t per_kick = scene.kick_interval();
  const double interval = scene.time.step * static_cast<double>(per_kick);
  assert(orbits >= 0.0 && interval > 0.0);
  const double kicks = orbits / interval;
  if (!(kicks < 1e15))
    config::fail_at(settings.location(key),
                    fmt::format("{} = {} is too long (more than 1e15 steps of {}); lower it or raise time.step", key,
                                orbits, scene.time.step));
  if (orbits == 0.0)
    return 0;
  std::int64_t whole = std::max<std::int64_t>(1, std::llround(kicks));
  if (whole > 1 && !find_key(key)->range.contains(static_cast<double>(whole) * interval))
    --whole; // the resolved scene must be valid
  const std::int64_t steps = whole * per_kick;
  if (std::fabs(kicks - static_cast<double>(whole)) > 1e-9 * kicks) {
    const double rounded = static_cast<double>(steps) * scene.time.step;
    const std::string kicks_every = scene.time.automatic ? "longest steps"
                                    : per_kick > 1       ? fmt::format("kicks, one every {} steps", per_kick)
                                                         : "steps";
    if (settings.given(key))
      scene.notices.push_back(fmt::format("{} = {} is rounded to {:.12g} orbits (whole {} of {} orbits)", key, orbits,
                                          rounded, kicks_every, scene.time.automatic ? interval : scene.time.step));
    settings.resolve(key, rounded);
  }
  return steps;
}

} // namespace

// Searches for contacts slow down with the number of oscillations per step: 3 times at 1, 15 times at 1.5, without
// bound at 2 (docs/dev/drift.md).
void refuse_many_oscillations(const Scene& scene, const config::Settings& settings) {
  const Frequencies& frequencies = scene.planet.frequencies;
  const double fastest = std::max(frequencies.kappa, frequencies.nu);
  if (scene.oscillations_per_step() > TimeSettings::max_oscillations)
    config::fail_at(
        settings.location("time.step"),
        fmt::format("time.step = {} is {} {} oscillations of {} Omega (above {:g} the searches for contacts take "
                    "too long); lower it to at most {} orbits",
                    format_number(scene.time.step), format_number(scene.oscillations_per_step(), 3),
                    frequencies.nu < frequencies.kappa ? "radial" : "vertical", format_number(fastest),
                    TimeSettings::max_oscillations, format_number(TimeSettings::few_oscillations / fastest, 3)));
}

void read_times(Scene& scene, config::Settings& settings) {
  scene.time.automatic = settings.is_word("time.step");
  scene.time.step = scene.time.automatic ? 1.0 / TimeSettings::ticks_per_orbit : settings.number("time.step");
  if (scene.time.automatic && scene.gravity && scene.gravity->kick_every != 1)
    config::fail_at(
        settings.location("gravity.kick_every"),
        "gravity.kick_every cannot be combined with time.step = \"auto\" (which sets the kick interval); remove one of "
        "the two");
  scene.time.end_step = whole_kicks(scene, settings, "time.end");
  scene.output.series_every = whole_kicks(scene, settings, "output.series_every");
  scene.output.stress_every = whole_kicks(scene, settings, "output.stress_every");
  scene.output.snapshot_every = whole_kicks(scene, settings, "output.snapshot_every");
  scene.output.checkpoint_every = whole_kicks(scene, settings, "output.checkpoint_every");
  scene.output.checkpoint_every_minutes = settings.number("output.checkpoint_every_minutes");
}

} // namespace keeler::scene
