// The cheapest settings of a scene that are as accurate as one asks for, found by short probes on the state that the
// scene comes to: gravity's solver and its accuracy, the kick interval, the step, threads; and how long the run will
// take with them. docs/dev/tune.md says how.
#pragma once

#include <keeler/bench/gravity.hpp>
#include <keeler/config/edit.hpp>
#include <keeler/core/progress.hpp>
#include <keeler/scene/scene.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace keeler {

/// The part of a tolerance that the probes are held to, since another seed has another error (docs/dev/tune.md).
inline constexpr double margin_for_seeds = 0.8;

struct TuneSettings {
  double force_error = 4e-3;         ///< rms error of the force that is allowed
  double physics_error = 0.01;       ///< share of the loss of energy that kicks may make beyond the work of the shear
  std::optional<double> orbits = {}; ///< the state's age when it is probed; none: 4, or 8 without self-gravity
  int max_threads = 1;
  std::function<void(const Progress&)> progress = {}; ///< may be empty
};

/// What a kick interval makes.
struct KickProbe {
  double interval = 0.0;         ///< orbits
  double unresolved = 0.0;       ///< share of the contacts that are slower than a kick of the pair's own gravity
  double unresolved_error = 0.0; ///< standard error, by the scatter of the states that were probed

  /// What the loss exceeds the work by, as measured in wakes (docs/dev/step.md).
  double physics_error() const { return 1.25 * unresolved; }
};

/// What a step costs, with the kick interval and the solver that were chosen.
struct StepProbe {
  double step = 0.0;     ///< orbits
  int drifts = 1;        ///< a kick
  double contacts = 0.0; ///< a particle and drift
  double seconds = 0.0;  ///< of the processor, an orbit: mean over the states, in turns with the others
};

struct ThreadProbe {
  int threads = 1;
  double speedup = 1.0; ///< wall time on one over wall time on so many
};

struct Tuning {
  std::size_t particles = 0;
  double orbits = 0.0; ///< the age of the last of the states that were probed

  std::vector<GravityBenchRow> gravity; ///< empty without self-gravity
  std::size_t chosen_gravity = 0;
  bool meets_force_error = true; ///< with the margin; else the most accurate is chosen
  std::vector<KickProbe> kicks;  ///< in the order of the probes; empty without self-gravity
  std::size_t chosen_kicks = 0;
  bool meets_physics_error = true; ///< with the margin; else the shortest is chosen
  std::vector<StepProbe> steps;
  std::size_t chosen_step = 0;
  std::vector<ThreadProbe> threads; ///< one thread, and what the machine offers
  int chosen_threads = 1;

  double processor_seconds = 0.0; ///< predicted, of the whole run on one thread
  double wall_seconds = 0.0;      ///< the same on the threads that were chosen
};

/// Evolves the scene's state and probes it. Throws what initial_patch() and Simulation throw; Interrupted.
Tuning tune(const Scene& scene, const TuneSettings& settings);

/// The keys that say what was chosen, each with a comment on its price and error. `scene` is the one that was tuned.
std::vector<KeyChange> chosen_keys(const Tuning& tuning, const TuneSettings& settings, const Scene& scene);

} // namespace keeler
