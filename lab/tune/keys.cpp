#include <keeler/tune/tune.hpp>

#include <keeler/core/format.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::tune {
namespace {

std::string per_cent(double fraction) {
  return format_number(100.0 * fraction, 2) + " %";
}

// Formats a number as TOML float, with a decimal point or an exponent.
std::string with_point(double number) {
  assert(std::isfinite(number));
  const std::string digits = fmt::format("{}", number);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

void add_gravity(std::vector<ChosenKey>& keys, const Tuning& tuning, const TuneSettings& settings) {
  using Solver = GravitySettings::Solver;
  assert(tuning.chosen_gravity < tuning.gravity.size());
  const bench::GravityBenchRow& row = tuning.gravity[tuning.chosen_gravity];
  const GravitySettings& gravity = row.choice.settings;
  keys.push_back(
      {"gravity.solver", fmt::format("\"{}\"", row.choice.solver),
       fmt::format("an rms force error of {} was measured (at most {}{})", per_cent(row.errors.rms),
                   per_cent(settings.force_error),
                   tuning.meets_force_error ? "" : ", which no setting meets with a margin for other seeds")});
  if (gravity.solver == Solver::fft)
    keys.push_back({"gravity.force_error", with_point(gravity.force_error), ""});
  if (gravity.solver == Solver::tree)
    keys.push_back({"gravity.opening_angle", with_point(gravity.opening_angle), ""});
}

void add_kicks(std::vector<ChosenKey>& keys, const Tuning& tuning, const TuneSettings& settings) {
  assert(tuning.chosen_kicks < tuning.kicks.size());
  const KickProbe& kicks = tuning.kicks[tuning.chosen_kicks];
  keys.push_back(
      {"gravity.kick_every", fmt::format("{}", tuning.steps[tuning.chosen_step].drifts),
       fmt::format("with a kick every {:g} orbits {} of the contacts are unresolved; the loss over the "
                   "work of the shear errs by up to {} (at most {}{})",
                   kicks.interval, per_cent(kicks.unresolved), per_cent(kicks.physics_error()),
                   per_cent(settings.physics_error),
                   tuning.meets_physics_error ? "" : ", which no interval meets with a margin for other seeds")});
}

} // namespace

std::vector<ChosenKey> chosen_keys(const Tuning& tuning, const TuneSettings& settings, const Scene& scene) {
  std::vector<ChosenKey> keys;
  if (scene.gravity) {
    add_gravity(keys, tuning, settings);
    add_kicks(keys, tuning, settings);
  }
  assert(tuning.chosen_step < tuning.steps.size());
  const StepProbe& step = tuning.steps[tuning.chosen_step];
  keys.push_back({"time.step", with_point(step.step),
                  fmt::format("{} processor seconds per orbit in the state after {:.3g} orbits, {} contacts per "
                              "particle and drift",
                              format_number(step.seconds, 2), tuning.orbits, format_number(step.contacts, 2))});
  return keys;
}

std::string tuned_scene(const Scene& scene, const std::vector<ChosenKey>& keys) {
  std::string comments;
  std::vector<std::string> overrides;
  for (const ChosenKey& key : keys) {
    overrides.push_back(key.path + "=" + key.value);
    if (!key.comment.empty())
      comments += fmt::format("# tune: {} = {}: {}\n", key.path, key.value, key.comment);
  }
  return comments + parse_scene(scene.resolved, "the resolved scene", overrides).resolved;
}

} // namespace keeler::tune
