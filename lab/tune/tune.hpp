// Finds the cheapest settings of a scene within given tolerances, by short probes on the state that the scene evolves
// to: gravity's solver and its accuracy, the kick interval, the step, and the number of threads. It also predicts the
// duration of the run with them. docs/dev/tune.md describes the method.
#pragma once

#include <keeler/bench/gravity.hpp>
#include <keeler/core/progress.hpp>
#include <keeler/scene/scene.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keeler::tune {

/// Fraction of a tolerance that the probes must meet, since the error varies between seeds (docs/dev/tune.md).
inline constexpr double margin_for_seeds = 0.8;

struct TuneSettings {
  double force_error = 4e-3;   ///< largest rms error of the force
  double physics_error = 0.01; ///< largest relative error by kicks, of the loss over the work of the shear and of ν
  std::optional<double> orbits = {}; ///< age of the probed state; default 4, 8 without self-gravity
  int max_threads = 1;
  std::function<void(const Progress&)> progress = {}; ///< may be empty
};

/// Effect of a kick interval.
struct KickProbe {
  double interval = 0.0;         ///< orbits
  double unresolved = 0.0;       ///< fraction of the contacts that are slower than a kick by the pair's mutual gravity
  double unresolved_error = 0.0; ///< standard error, from the scatter of the probed states

  /// Returns an upper limit of the relative error of the loss over the work and of ν, as measured in wakes and dense
  /// patches (docs/dev/step.md).
  double physics_error() const { return 0.1 * unresolved; }
};

/// Cost of a step with the chosen kick interval and solver.
struct StepProbe {
  double step = 0.0;     ///< orbits
  int drifts = 1;        ///< per kick
  double contacts = 0.0; ///< per particle and drift
  double seconds = 0.0;  ///< processor time per orbit: mean over the states, measured in turn with the other steps
};

struct ThreadProbe {
  int threads = 1;
  double speedup = 1.0; ///< wall time on one thread over wall time on `threads`
};

struct Tuning {
  std::size_t particles = 0;
  double orbits = 0.0; ///< age of the last probed state

  std::vector<bench::GravityBenchRow> gravity; ///< empty without self-gravity
  std::size_t chosen_gravity = 0;
  bool meets_force_error = true; ///< with the margin; if false, the most accurate one is chosen
  std::vector<KickProbe> kicks;  ///< in the order of the probes; empty without self-gravity
  std::size_t chosen_kicks = 0;
  bool meets_physics_error = true; ///< with the margin; if false, the shortest one is chosen
  std::vector<StepProbe> steps;
  std::size_t chosen_step = 0;
  std::vector<ThreadProbe> threads; ///< one thread, and numbers up to max_threads
  int chosen_threads = 1;

  double processor_seconds = 0.0; ///< prediction for the whole run on one thread
  double wall_seconds = 0.0;      ///< prediction for the whole run on the chosen threads
};

/// Evolves the scene's state and probes it. Precondition: tolerances, `orbits` and `max_threads` are positive.
/// Throws UsageError for axisymmetric gravity, what initial_patch() and Simulation throw, and Interrupted.
Tuning tune(const Scene& scene, const TuneSettings& settings);

struct ChosenKey {
  std::string path;    ///< "gravity.kick_every"
  std::string value;   ///< TOML
  std::string comment; ///< its cost or error; may be empty
};

/// Returns the chosen settings as scene keys. Precondition: `tuning` is the result of tune() for `scene`.
std::vector<ChosenKey> chosen_keys(const Tuning& tuning, const TuneSettings& settings, const Scene& scene);

/// Returns the resolved text of the scene with these keys, below their comments.
std::string tuned_scene(const Scene& scene, const std::vector<ChosenKey>& keys);

} // namespace keeler::tune
