#include <keeler/runs/run.hpp>

#include "broken_state.hpp"
#include "distributed_request.hpp"
#include "edited_scene.hpp"
#include "recorder.hpp"
#include "runner.hpp"
#include "summarise.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/advice/warnings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/io/checkpoint.hpp>
#include <keeler/io/checkpoint_folder.hpp>
#include <keeler/runs/folder_lock.hpp>
#include <keeler/runs/patch_units.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <thread>

namespace keeler::runs {
namespace {

// Returns `steps` rounded to whole kick intervals, at least one.
std::int64_t whole_kicks(const Scene& scene, double steps) {
  assert(scene.kick_interval() > 0);
  const auto block = static_cast<double>(scene.kick_interval());
  return static_cast<std::int64_t>(std::max(1.0, std::round(steps / block)) * block);
}

std::string resume_command(const RunOptions& options) {
  const std::string until = options.until_orbits ? fmt::format(" --until {}", *options.until_orbits) : "";
  return fmt::format("keeler resume {}{}", options.folder.string(), until);
}

// A full disk leaves the newest checkpoint intact: the message says how to continue.
template<class Work> RunResult with_advice(const RunOptions& options, const Work& work) {
  try {
    return work();
  } catch (const DiskFullError& full) {
    const std::string advice = io::list_checkpoints(options.folder).empty()
                                   ? "start again with --force (there is no checkpoint yet)"
                                   : fmt::format("continue with \"{}\"", resume_command(options));
    throw DiskFullError(fmt::format("{}; free some space, then {}", full.what(), advice));
  }
}

// The times when the command began, and the step of the checkpoint that it loaded.
struct Start {
  double cpu = cpu_seconds(), wall = 0.0;
  Stopwatch watch{wall};
  double made_s = 0.0; // wall time until the initial state was ready
  std::int64_t checkpoint_step = -1;
};

// Ends a run in the middle of a step: its state in memory is unusable, only the files on disk count.
[[noreturn]] void fail_given_up(const RunOptions& options, std::int64_t last_checkpoint, Recorder& recorder) {
  if (options.ranks.is_root())
    recorder.write_log("given up", {{"checkpoint_step", last_checkpoint}});
  if (last_checkpoint < 0)
    throw Error(ExitCode::run_time, "a step was given up on request before there was a checkpoint; start again, with "
                                    "output.checkpoint_every or, where steps do not end, with a shorter time.step");
  throw Error(
      ExitCode::stopped,
      fmt::format("a step was given up on request; the checkpoint of step {} is intact, continue from it with \"{}\"",
                  last_checkpoint, resume_command(options)));
}

// Throws IoError if the folder of the run was moved or removed, which explains a write that failed better than the
// write does. A removal takes the files of a folder before the folder itself, so the folder is looked for during half a
// second.
void look_for_folder(const Recorder& recorder) {
  constexpr int looks = 10;
  for (int k = 0; k < looks; ++k) {
    recorder.require_folder();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

RunResult evolve(const Scene& scene, const RunOptions& options, RunRequests& requests, const RunFolder& folder,
                 Simulation& simulation, Recorder& recorder, const Start& start) {
  const std::int64_t first_step = simulation.state().control.steps;
  const double first_orbit = simulation.orbits();
  recorder.watch(simulation);
  Runner runner(scene, options, requests, simulation, recorder, start.watch, start.checkpoint_step);
  RunResult result;
  try {
    result = runner.run();
    result.resume_command = resume_command(options);
  } catch (const Interrupted&) {
    fail_given_up(options, runner.last_checkpoint(), recorder);
  } catch (const IoError&) {
    if (options.ranks.is_root())
      look_for_folder(recorder);
    throw;
  } catch (const Error& error) {
    // particles are distributed: all ranks must know of the error
    if (error.code() == ExitCode::invariant && (!options.ranks.distributed() || comm::take_common_error()))
      fail_broken(InvariantError(error.what()), simulation, scene, folder, recorder);
    throw;
  }
  const RunCost cost{.first_step = first_step,
                     .first_orbit = first_orbit,
                     .wall_s = start.watch.elapsed(),
                     .cpu_s = cpu_seconds() - start.cpu,
                     .start_s = start.made_s,
                     .output = recorder.costs(),
                     .force_checks = recorder.force_checks()};
  const RingScale scale{.mass = simulation.means().mass,
                        .orbital_frequency = scene.planet.orbital_frequency,
                        .shear = simulation.state().box.shear,
                        .driven = !scene.external_forces.empty(),
                        .attracts = scene.gravity.has_value()};
  std::optional<Transport> transport;
  if (options.ranks.is_root())
    transport = transport_of_run(folder.series(), scale, options.notice);
  result.summary = summarise(simulation, scene, transport, result, cost, recorder.provenance());
  recorder.summary(result.summary);
  recorder.log(result.finished ? "finished" : "stopped", {{"step", result.step}, {"state_hash", result.state_hash}});
  return result;
}

struct Loaded {
  StoredRun run;
  std::string scene_text; // as stored in the checkpoint
  OutputCounters counters;
};

// Loads a checkpoint. Collective: each rank gets a part of the particles.
Loaded load(const std::filesystem::path& file, const Communicator& ranks = {}) {
  Loaded loaded;
  const io::Checkpoint checkpoint(file, ranks);
  loaded.scene_text = checkpoint.header().scene;
  ranks.together([&] { loaded.run.scene = scene::parse_stored_scene(loaded.scene_text, file.string()); });
  loaded.run.state = simulation::SimulationState(loaded.run.scene);
  FieldTable table = loaded.run.state.fields();
  loaded.counters.list_fields(table, loaded.run.scene);
  checkpoint.read(table);
  const std::string fault = loaded.run.state.fault(loaded.run.scene, ranks);
  ranks.together([&] {
    if (!fault.empty())
      throw IoError(fmt::format("checkpoint '{}' does not fit: {}", file.string(), fault));
  });
  return loaded;
}

// Returns the scene with the requested end, rounded to whole kicks.
Scene until(Scene scene, const RunOptions& options, std::int64_t step) {
  if (!options.until_orbits)
    return scene;
  const double asked = *options.until_orbits, now = static_cast<double>(step) * scene.time.step;
  if (!(asked / scene.time.step < 1e15))
    throw UsageError(fmt::format("--until {:g} is too long (a step of {:g} makes more than 1e15 steps); lower it",
                                 asked, scene.time.step));
  scene.time.end_step = whole_kicks(scene, asked / scene.time.step);
  const double end = end_orbits(scene);
  if (scene.time.end_step < step)
    throw UsageError(fmt::format("the run in '{}' is already at orbit {:.6g}, after the requested end (orbit {:.6g}); "
                                 "give a later end",
                                 options.folder.string(), now, asked));
  if (options.notice && std::abs(end - asked) > 1e-9 * asked)
    options.notice(fmt::format("the end is rounded to whole kicks: orbit {:.6g} instead of {:.6g}", end, asked));
  return scene;
}

struct Begun {
  Scene scene; // with the settings that depend on the initial state
  Simulation simulation;
  scene::PatchScale scale;
};

// Makes the initial state. A stop request ends it at once, since no result could be kept; distributed ranks check for
// the request together, at each progress report.
Begun first_simulation(const Scene& scene, const RunOptions& options, const RunRequests& requests) {
  const Communicator& ranks = options.ranks;
  const std::atomic<bool> never = false;
  const auto progress = [&](const initial_conditions::StartProgress& now) {
    if (ranks.any(requests.stop))
      throw Interrupted();
    if (options.start_progress)
      options.start_progress(now);
  };
  try {
    const Interruptible start(ranks.distributed() ? never : requests.stop);
    if (!scene.start_from)
      ranks.together([&] {
        const std::size_t all = scene.particles.count;
        advice::require_memory_for(scene, (all + ranks.size() - 1) / ranks.size(), all);
      });
    const Patch patch = initial_patch(scene, progress, ranks);
    const scene::PatchScale scale = ranks.broadcast(initial_conditions::scale_of(patch, ranks));
    const Scene decided = decided_by(scene, scale);
    return {decided, Simulation(decided, patch, ranks), scale};
  } catch (const Interrupted&) {
    const Error stopped(ExitCode::run_time,
                        "stopped before the first step (on request), so nothing is written; start again");
    ranks.together([&] { throw stopped; });
    throw stopped;
  }
}

void send_notices(const Scene& scene, const RunOptions& options, const scene::PatchScale& scale) {
  if (!options.notice)
    return;
  for (const std::string& notice : scene.notices)
    options.notice("note: " + notice);
  for (const std::string& warning : advice::warnings(scene, scale))
    options.notice("note: " + warning);
}

RunResult begin(const Scene& asked, const RunOptions& options, RunRequests& requests) {
  Start start;
  const Communicator& ranks = options.ranks;
  const RunFolder folder(options.folder);
  require_same_run(asked, options);
  ranks.on_root([&] { initial_conditions::require_start_file(asked); });
  ranks.on_root([&] {
    if (!options.force)
      folder.refuse_if_occupied(); // before the costly initial state
    folder.require_writable();
  });
  Begun begun = first_simulation(asked, options, requests);
  const Scene& scene = begun.scene;
  Simulation& simulation = begun.simulation;
  start.made_s = start.watch.elapsed();
  std::optional<FolderLock> lock;
  ranks.on_root([&] {
    folder.make();
    lock.emplace(folder.path());
    folder.claim(options.force);
  });
  send_notices(scene, options, begun.scale);
  Recorder recorder(folder, lock ? &*lock : nullptr, scene, options.arguments, {}, std::nullopt, options.notice, ranks);
  recorder.log("started", {{"particles", simulation.count()},
                           {"end_orbits", end_orbits(scene)},
                           {"threads", threads()},
                           {"ranks", ranks.size()}});
  recorder.snapshot(simulation);
  recorder.sample(simulation);
  return evolve(scene, options, requests, folder, simulation, recorder, start);
}

// Returns the newest valid checkpoint, which the root searches. Each rank uses its own path to the folder.
std::filesystem::path newest_checkpoint(const RunOptions& options) {
  std::string name;
  options.ranks.on_root([&] {
    const io::NewestCheckpoint newest = io::newest_valid_checkpoint(options.folder);
    if (options.notice)
      for (const std::string& warning : newest.warnings)
        options.notice(warning);
    name = newest.path.filename().string();
  });
  options.ranks.broadcast(name);
  return options.folder / name;
}

void report_edited_scene(const RunFolder& folder, const Scene& scene, const Loaded& loaded, const RunOptions& options,
                         bool resumes) {
  std::optional<EditedScene> edited = EditedScene::in(folder, loaded.scene_text, scene);
  if (!edited)
    return;
  if (resumes)
    edited->keep_apart();
  if (options.notice)
    options.notice(edited->notice(folder.snapshot(std::max<std::int64_t>(loaded.counters.snapshots - 1, 0))));
}

RunResult resume(const RunOptions& options, RunRequests& requests) {
  Start start;
  const Communicator& ranks = options.ranks;
  const RunFolder folder(options.folder);
  require_same_run(options);
  std::optional<FolderLock> lock;
  ranks.on_root([&] { lock.emplace(folder.path()); });
  const std::filesystem::path newest = newest_checkpoint(options);
  Loaded loaded = load(newest, ranks);
  Scene scene;
  ranks.together([&] { scene = until(std::move(loaded.run.scene), options, loaded.run.state.step); });
  const std::int64_t step = start.checkpoint_step = loaded.run.state.step;
  ranks.on_root([&] { folder.cut_log(); });
  if (step >= scene.time.end_step && ranks.broadcast(says_finished(folder.path()))) {
    ranks.on_root([&] { report_edited_scene(folder, scene, loaded, options, false); });
    if (options.notice)
      options.notice(fmt::format("the run in '{}' is finished, nothing was changed; --until with a later orbit than "
                                 "{:.6g} continues it",
                                 options.folder.string(), static_cast<double>(step) * scene.time.step));
    RunResult result{true, step, state_hash(loaded.run.state, scene, ranks), resume_command(options)};
    const simulation::SimulationState& state = loaded.run.state;
    const quantities::PatchUnits units =
        units_of(state.particles, state.box.area(), scene.planet.orbital_frequency, ranks);
    ranks.on_root([&] {
      result.summary = read_summary(options.folder);
      result.summary.units = units;
    });
    return result;
  }
  Simulation simulation(scene, std::move(loaded.run.state), ranks);
  ranks.on_root([&] {
    report_edited_scene(folder, scene, loaded, options, true);
    folder.cut_snapshots(loaded.counters.snapshots);
    folder.remove_summary();
    io::prune_checkpoints(newest);
  });
  Recorder recorder(folder, lock ? &*lock : nullptr, scene, options.arguments, loaded.counters, step, options.notice,
                    ranks);
  recorder.report_losses();
  recorder.log("resumed", {{"checkpoint", newest.filename().string()},
                           {"step", step},
                           {"orbits", simulation.orbits()},
                           {"end_orbits", end_orbits(scene)},
                           {"threads", threads()},
                           {"ranks", ranks.size()}});
  return evolve(scene, options, requests, folder, simulation, recorder, start);
}

} // namespace

StoredRun load_checkpoint(const std::filesystem::path& file) {
  return load(file).run;
}

StoredRun load_newest_checkpoint(const std::filesystem::path& folder,
                                 const std::function<void(const std::string&)>& notice) {
  RunOptions options;
  options.folder = folder;
  options.notice = notice;
  Loaded loaded = load(newest_checkpoint(options));
  report_edited_scene(RunFolder(folder), loaded.run.scene, loaded, options, false);
  return std::move(loaded.run);
}

void store_checkpoint(const std::filesystem::path& file, const simulation::SimulationState& state, const Scene& scene) {
  OutputCounters counters;
  FieldTable table = state.fields();
  counters.list_fields(table, scene);
  io::write_checkpoint(file, table, {scene.resolved, io::collect_provenance({})});
}

RunResult start_run(const Scene& scene, const RunOptions& options, RunRequests& requests) {
  return with_advice(options, [&] { return begin(scene, options, requests); });
}

RunResult resume_run(const RunOptions& options, RunRequests& requests) {
  return with_advice(options, [&] { return resume(options, requests); });
}

} // namespace keeler::runs
