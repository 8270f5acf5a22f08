#include <keeler/bench/step.hpp>

#include "gravity_states.hpp"

#include <keeler/comm/same_request.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/keys_in_force.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::bench {
namespace {

constexpr double max_steps = 100.0; // per repeat

BenchState stored_state(const std::string& file) {
  io::Snapshot snapshot = io::read_snapshot(file);
  BenchState state{scene::parse_stored_scene(snapshot.meta.scene, file), {}};
  if (!state.scene.gravity)
    throw UsageError(
        fmt::format("'{}' has a scene without self-gravity (the scene has no [gravity]); use a snapshot of a run "
                    "with gravity, or time the drift alone with \"keeler bench drift\"",
                    file));
  state.patch = initial_conditions::patch_from_snapshot(std::move(snapshot.patch), file, state.scene);
  return state;
}

GravityChoice choice_for(const StepBenchSettings& settings, const BenchState& state) {
  GravityChoice choice = default_gravity_choice(settings.solver.value_or("tree"));
  if (settings.from) {
    GravitySettings gravity = *state.scene.gravity;
    if (settings.solver) {
      gravity = {};
      gravity.solver = choice.settings.solver; // Simulation derives the cut from the snapshot's masses
      gravity.kick_every = state.scene.gravity->kick_every;
    }
    choice = choice_of(gravity, state.patch.size());
  }
  choice.settings.kick_every = settings.kick_every.value_or(choice.settings.kick_every);
  choice.settings.resting_contacts = state.scene.gravity->resting_contacts;
  return choice;
}

// Throws when the ranks have different requests. Each rank read its command line and made its scene itself; only the
// particles come from rank 0.
void require_same_bench(const StepBenchSettings& settings, const BenchState& state, const GravityChoice& choice) {
  std::vector<comm::RequestEntry> request = {{"--count", fmt::format("{}", settings.count)},
                                             {"--state", settings.state},
                                             {"--repeats", fmt::format("{}", settings.repeats)},
                                             {"--solver", choice.solver},
                                             {"--kick-every", fmt::format("{}", choice.settings.kick_every)},
                                             {"the solver's settings", choice.text},
                                             {"particles", fmt::format("{}", state.patch.size())}};
  settings.ranks.together([&] {
    for (const scene::KeyInForce& key : keys_in_force(state.scene))
      request.push_back({key.path, key.value});
  });
  require_same_request(request, settings.ranks);
}

// Returns `steps`, rounded up to whole kick intervals.
int whole_intervals(double steps, int kick_every) {
  assert(kick_every > 0);
  return static_cast<int>(std::ceil(steps / kick_every)) * kick_every;
}

} // namespace

StepBench bench_step(const StepBenchSettings& settings) {
  PhaseProgress progress(settings.progress);
  BenchState state;
  StepBench bench;
  settings.ranks.together([&] {
    const Stopwatch watch(bench.preparation_s);
    state = settings.from ? stored_state(*settings.from) : gravity_state(settings.count, settings.state, progress);
    bench.choice = choice_for(settings, state);
  });
  require_same_bench(settings, state, bench.choice);
  state.scene.gravity = bench.choice.settings;
  bench.step_orbits = state.scene.time.step;
  bench.dispersion_r_omega =
      diagnostics::velocity_in_radii(state.patch, diagnostics::velocity_dispersion(state.patch)).x();
  const int kick_every = bench.choice.settings.kick_every;
  const int steps = whole_intervals(steps_worth_timing(state.patch.size(), bench.step_orbits, max_steps), kick_every);

  Simulation simulation(state.scene, settings.ranks.is_root() ? state.patch : Patch(), settings.ranks);
  std::optional<Simulation> alone;
  if (settings.ranks.distributed() && settings.ranks.is_root())
    alone.emplace(state.scene, state.patch);
  state.patch = {}; // frees memory: a large state is stored once, on rank 0 twice
  bench.timed = time_steps(simulation, steps, settings.repeats, kick_every, progress, alone ? &*alone : nullptr);
  return bench;
}

} // namespace keeler::bench
