// A run and its folder: steps, output schedules, checkpoints, and a graceful stop that loses no step.
//
// The folder holds scene.toml (resolved), snap_NNNNNN.hdf, checkpoint_NNNNNN.h5 (the last two), series.csv,
// summary.json and log.jsonl. A snapshot is always written at the start and at the end, and a checkpoint at the end or
// at a stop. Files are numbered from 000000 in the order of writing; a resumed run continues the numbers of its
// checkpoint. summary.json exists once the run has ended or stopped, not while it runs or after it was killed.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keeler::runs {

/// Requests set by a signal handler or another thread. They take effect at the end of a step, `give_up` at once.
struct RunRequests {
  std::atomic<bool> stop = false;     ///< write a checkpoint and stop; an unfinished initial state is discarded
  std::atomic<bool> snapshot = false; ///< write a snapshot and continue
  std::atomic<bool> give_up = false;  ///< stop at once; the steps since the last checkpoint are lost
  /// Set by the run: upper estimate of the duration of a graceful stop (s, ≥ 5), from the steps so far. After it, the
  /// caller may set `give_up`. 0 before the first step.
  std::atomic<unsigned> stop_timeout_s = 0;
};

/// The progress of a run, reported after each step.
struct RunProgress {
  std::int64_t step = 0;              ///< ticks done
  std::int64_t first_step = 0;        ///< tick at which this command began
  std::int64_t end_step = 0;          ///< tick at which the run ends
  double orbits = 0.0;                ///< orbits done
  double end_orbits = 0.0;            ///< orbits at the end
  double elapsed_s = 0.0;             ///< wall time since this command started or resumed the run
  double remaining_s = 0.0;           ///< estimated wall time to the end
  double collisions_per_second = 0.0; ///< per second of wall time, since this command began
};

/// Options of a run, as `keeler run` and `keeler resume` have them.
struct RunOptions {
  std::filesystem::path folder;       ///< of the run
  bool force = false;                 ///< replace an existing run in the folder
  bool check = false;                 ///< check all invariants after each step
  std::optional<double> until_orbits; ///< end of the run instead of the scene's
  std::optional<double> wall_time_s;  ///< stop with a checkpoint before this much wall time has passed
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const initial_conditions::StartProgress&)> start_progress; ///< called while the start is made
  std::function<void(const RunProgress&)> progress;                             ///< called after each step
  /// Called before the first step, and after each step that ends a kick interval; may wait. Must not change the run.
  std::function<void(const Simulation&)> observe;
  Communicator ranks = {}; ///< processes of the run: all call with equal options, the root writes the folder
  std::function<void(const std::string&)> notice; ///< receives lines for the user: rounding, skipped checkpoints
};

/// How a run ended.
struct RunResult {
  bool finished = false;        ///< false: stopped on request; a checkpoint is on disk
  std::int64_t step = 0;        ///< ticks done
  std::string state_hash;       ///< 32 hexadecimal digits; states of equal hashes are bitwise equal
  std::string resume_command;   ///< the command that continues the run, for messages
  quantities::Record summary{}; ///< the content of summary.json
};

/// Starts a run. Throws UsageError if the folder already holds a run and `force` is false; IoError; InvariantError,
/// whose message after the first step names broken_NNNNNN.hdf, the saved state; DiskFullError, with advice how to
/// continue; Error (stopped, or run_time without a checkpoint) after `give_up`, or after `stop` before the initial
/// state was made: then nothing is written.
RunResult start_run(const Scene& scene, const RunOptions& options, RunRequests& requests);

/// Continues the run of a folder from its newest valid checkpoint. A finished run is not changed, and a notice says so.
/// Throws IoError if there is no checkpoint, and as start_run().
RunResult resume_run(const RunOptions& options, RunRequests& requests);

/// The state of a checkpoint, and its scene.
struct StoredRun {
  Scene scene;                       ///< as stored with it
  simulation::SimulationState state; ///< from which the run continues
};
/// Reads a checkpoint. Throws IoError.
StoredRun load_checkpoint(const std::filesystem::path& file);

/// Loads the newest valid checkpoint of a run's folder. `notice` receives a line for each damaged checkpoint skipped,
/// and one if scene.toml was edited; that file is not changed. Throws IoError.
StoredRun load_newest_checkpoint(const std::filesystem::path& folder,
                                 const std::function<void(const std::string&)>& notice);

/// Writes a state as the checkpoint of a run without output so far: named checkpoint_000000.h5 in an otherwise empty
/// folder, `keeler resume` continues from it. Precondition: the state is between two kick intervals. Throws IoError.
void store_checkpoint(const std::filesystem::path& file, const simulation::SimulationState& state, const Scene& scene);

} // namespace keeler::runs
