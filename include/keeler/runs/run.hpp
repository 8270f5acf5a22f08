// A run and its folder: steps, schedules of output, checkpoints, and stopping without losing anything.
//
// The folder holds scene.toml (resolved), snap_NNNNNN.hdf, checkpoint_NNNNNN.h5 (the last two), series.csv,
// summary.json and log.jsonl. There is always a snapshot at the start and at the end, and a checkpoint at the end or at
// a stop. Files are numbered as they are written, from 000000; a resumed run goes on counting from its checkpoint.
// summary.json is there when the run has ended or stopped, not while it works or when it was killed.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/initial_conditions/progress.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// Requests from outside, set by a signal handler or another thread; obeyed at the end of the step, `give_up` at once.
struct RunRequests {
  std::atomic<bool> stop = false;     ///< write a checkpoint and stop; a start that is still being made is given up
  std::atomic<bool> snapshot = false; ///< write a snapshot and go on
  std::atomic<bool> give_up = false;  ///< leave the step at hand and all since the last checkpoint, and stop
  /// How long (s) a stop takes at most when nothing is wrong, by the steps so far, and at least 5: who asked for it may
  /// then ask to give up. 0 before there is a run.
  std::atomic<unsigned> patience_s = 0;
};

/// Where a run stands, after each step.
struct RunProgress {
  std::int64_t step = 0, first_step = 0, end_step = 0;
  double orbits = 0.0, end_orbits = 0.0;
  double elapsed_s = 0.0;             ///< wall time since the run began or resumed
  double remaining_s = 0.0;           ///< an estimate
  double collisions_per_second = 0.0; ///< of wall time, over the run so far
};

struct RunOptions {
  std::filesystem::path folder;
  bool force = false;                 ///< replace the run that the folder holds
  bool check = false;                 ///< all invariants at each step
  std::optional<double> until_orbits; ///< another end than the scene's
  std::optional<double> wall_time_s;  ///< stop with a checkpoint before this much wall time has passed
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const StartProgress&)> start_progress;
  std::function<void(const RunProgress&)> progress;
  Communicator ranks = {}; ///< that share the run: all call with the same options, the first one writes the folder
  std::function<void(const std::string&)> notice; ///< a line for the user: rounding, a damaged checkpoint passed over
};

struct RunResult {
  bool finished = false; ///< false: stopped on request, a checkpoint is on disk
  std::int64_t step = 0;
  std::string state_hash;
  std::string resume_command; ///< goes on from here: for messages
  Record summary{};           ///< what summary.json holds
};

/// Starts a run. Throws UsageError when the folder holds a run already and force is not given, IoError; InvariantError,
/// after the first step with the state in broken_NNNNNN.hdf, which it names; DiskFullError says how to go on. Error
/// (stopped, or run_time when there is no checkpoint) when it was asked to give up a step, or to stop before the start
/// was made: then nothing is written.
RunResult start_run(const Scene& scene, const RunOptions& options, RunRequests& requests);

/// Continues the run of a folder from its newest whole checkpoint. A run that has reached its end is left as it is,
/// with a notice. Throws IoError when there is no checkpoint, and as start_run().
RunResult resume_run(const RunOptions& options, RunRequests& requests);

/// The state in a checkpoint, and its scene. Throws IoError.
struct StoredRun {
  Scene scene;
  SimulationState state;
};
StoredRun load_checkpoint(const std::filesystem::path& file);

/// The same of the newest whole checkpoint of a run's folder. `notice` gets a line on each damaged one that was passed
/// over, and on a scene.toml that was edited, which stays as it is.
StoredRun load_newest_checkpoint(const std::filesystem::path& folder,
                                 const std::function<void(const std::string&)>& notice);

/// Writes a state, where kicks meet, as the checkpoint of a run that has written nothing yet: in a folder of its own
/// and under the name checkpoint_000000.h5, `keeler resume` goes on from it. Throws IoError.
void store_checkpoint(const std::filesystem::path& file, const SimulationState& state, const Scene& scene);

} // namespace keeler
