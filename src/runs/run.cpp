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
#include <keeler/files/files.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/checkpoint.hpp>
#include <keeler/io/checkpoint_folder.hpp>
#include <keeler/runs/folder_lock.hpp>
#include <keeler/runs/state_hash.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

std::int64_t whole_kicks(const Scene& scene, double steps) {
  const auto block = static_cast<double>(scene.kick_interval());
  return static_cast<std::int64_t>(std::max(1.0, std::round(steps / block)) * block);
}

std::string resume_command(const RunOptions& options) {
  const std::string until = options.until_orbits ? fmt::format(" --until {}", *options.until_orbits) : "";
  return fmt::format("keeler resume {}{}", options.folder.string(), until);
}

// A full disk leaves the newest checkpoint as it was: the user hears how to go on.
template<class Work> RunResult with_advice(const RunOptions& options, const Work& work) {
  try {
    return work();
  } catch (const DiskFullError& full) {
    const std::string advice = list_checkpoints(options.folder).empty()
                                   ? "start again with --force (there is no checkpoint yet)"
                                   : fmt::format("continue with \"{}\"", resume_command(options));
    throw DiskFullError(fmt::format("{}; free some space, then {}", full.what(), advice));
  }
}

// When the command began, and the step whose checkpoint it found.
struct Start {
  double cpu = cpu_seconds(), wall = 0.0;
  Stopwatch watch{wall};
  double made_s = 0.0; // wall time until there was a state to evolve
  std::int64_t checkpoint_step = -1;
};

// The state is that of an unfinished step: what is on disk is all there is.
[[noreturn]] void fail_given_up(const RunOptions& options, std::int64_t last_checkpoint, Recorder& recorder) {
  if (options.ranks.is_root())
    recorder.write_log("given up", {{"checkpoint_step", last_checkpoint}});
  if (last_checkpoint < 0)
    throw Error(ExitCode::run_time, "a step was given up on request before there was a checkpoint; start again, with "
                                    "output.checkpoint_every or, where steps do not end, with a shorter time.step");
  throw Error(
      ExitCode::stopped,
      fmt::format("a step was given up on request; the checkpoint of step {} stands, continue from it with \"{}\"",
                  last_checkpoint, resume_command(options)));
}

RunResult carry_on(const Scene& scene, const RunOptions& options, RunRequests& requests, const RunFolder& folder,
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
  } catch (const InvariantError& error) {
    if (options.ranks.distributed())
      throw; // its particles are on many ranks, and not all of them may know
    fail_broken(error, simulation, scene, folder, recorder);
  } catch (const IoError&) {
    if (options.ranks.is_root())
      recorder.require_folder(); // a folder that was moved away in the middle of a write is the better reason
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
                        .driven = !scene.external_forces.empty()};
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
  std::string scene_text; // as the checkpoint has it
  OutputCounters counters;
};

// Collective: each rank gets a part of the particles.
Loaded load(const std::filesystem::path& file, const Communicator& ranks = {}) {
  Loaded loaded;
  const Checkpoint checkpoint(file, ranks);
  loaded.scene_text = checkpoint.header().scene;
  ranks.together([&] { loaded.run.scene = parse_stored_scene(loaded.scene_text, file.string()); });
  loaded.run.state = SimulationState(loaded.run.scene);
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
    throw UsageError(fmt::format("the run in '{}' is at orbit {:.6g} already (until orbit {:.6g} it cannot go); give a "
                                 "later end",
                                 options.folder.string(), now, asked));
  if (options.notice && std::abs(end - asked) > 1e-9 * asked)
    options.notice(fmt::format("the end is rounded to whole kicks: orbit {:.6g} instead of {:.6g}", end, asked));
  return scene;
}

struct Begun {
  Scene scene; // with what its start decides
  Simulation simulation;
  PatchScale scale;
};

// Until there is a run, a stop is heeded at once: there is nothing that could be kept. Ranks heed it together, after
// a sweep of a fresh start.
Begun first_simulation(const Scene& scene, const RunOptions& options, const RunRequests& requests) {
  const Communicator& ranks = options.ranks;
  const std::atomic<bool> never = false;
  const auto progress = [&](const StartProgress& now) {
    if (ranks.any(requests.stop))
      throw Interrupted();
    if (options.start_progress)
      options.start_progress(now);
  };
  try {
    const Interruptible start(ranks.distributed() ? never : requests.stop);
    if (!scene.start_from)
      ranks.together([&] { require_memory_for(scene, (scene.particles.count + ranks.size() - 1) / ranks.size()); });
    const Patch patch = initial_patch(scene, progress, ranks);
    const PatchScale scale = ranks.broadcast(scale_of(patch, ranks));
    const Scene decided = decided_by(scene, scale);
    return {decided, Simulation(decided, patch, ranks), scale};
  } catch (const Interrupted&) {
    const Error stopped(ExitCode::run_time,
                        "stopped before the first step (on request), so nothing is written; start again");
    ranks.together([&] { throw stopped; });
    throw stopped;
  }
}

// Before the work of an initial state, which tells how many particles there are.
void require_distributable_start(const Scene& scene, const RunOptions& options) {
  constexpr std::size_t many = 1000000;
  if constexpr (Communicator::possible)
    options.ranks.together([&] {
      if (options.ranks.distributed())
        Simulation::require_distributable(scene, many);
    });
}

void refuse_checks_of_many(const RunOptions& options) {
  options.ranks.together([&] {
    if (options.check && options.ranks.distributed())
      throw UsageError(
          "--check looks at all particles at once, and several ranks have them; leave it out, or run on one");
  });
}

void tell_notices(const Scene& scene, const RunOptions& options, const PatchScale& scale) {
  if (!options.notice)
    return;
  for (const std::string& notice : scene.notices)
    options.notice(notice);
  for (const std::string& warning : warnings(scene, scale))
    options.notice("note: " + warning);
}

RunResult begin(const Scene& asked, const RunOptions& options, RunRequests& requests) {
  Start start;
  const Communicator& ranks = options.ranks;
  const RunFolder folder(options.folder);
  require_same_run(asked, options);
  refuse_checks_of_many(options);
  ranks.on_root([&] { require_start_file(asked); });
  require_distributable_start(asked, options);
  ranks.on_root([&] {
    if (!options.force)
      folder.refuse_if_occupied(); // before the work of an initial state
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
  tell_notices(scene, options, begun.scale);
  Recorder recorder(folder, lock ? &*lock : nullptr, scene, options.arguments, {}, std::nullopt, options.notice, ranks);
  recorder.log("started", {{"particles", simulation.count()},
                           {"end_orbits", end_orbits(scene)},
                           {"threads", threads()},
                           {"ranks", ranks.size()}});
  recorder.snapshot(simulation);
  recorder.sample(simulation);
  return carry_on(scene, options, requests, folder, simulation, recorder, start);
}

// The newest whole checkpoint, which the first rank looks for. Each rank finds the folder by its own name of it.
std::filesystem::path newest_checkpoint(const RunOptions& options) {
  std::string name;
  options.ranks.on_root([&] {
    const NewestCheckpoint newest = newest_valid_checkpoint(options.folder);
    if (options.notice)
      for (const std::string& warning : newest.warnings)
        options.notice(warning);
    name = newest.path.filename().string();
  });
  options.ranks.broadcast(name);
  return options.folder / name;
}

void tell_edited_scene(const RunFolder& folder, const Scene& scene, const Loaded& loaded, const RunOptions& options,
                       bool goes_on) {
  std::optional<EditedScene> edited = EditedScene::in(folder, loaded.scene_text, scene);
  if (!edited)
    return;
  if (goes_on)
    edited->keep_apart();
  if (options.notice)
    options.notice(edited->notice(folder.snapshot(std::max<std::int64_t>(loaded.counters.snapshots - 1, 0))));
}

RunResult go_on(const RunOptions& options, RunRequests& requests) {
  Start start;
  const Communicator& ranks = options.ranks;
  const RunFolder folder(options.folder);
  require_same_run(options);
  refuse_checks_of_many(options);
  std::optional<FolderLock> lock;
  ranks.on_root([&] { lock.emplace(folder.path()); });
  const std::filesystem::path newest = newest_checkpoint(options);
  Loaded loaded = load(newest, ranks);
  Scene scene;
  ranks.together([&] { scene = until(std::move(loaded.run.scene), options, loaded.run.state.step); });
  const std::int64_t step = start.checkpoint_step = loaded.run.state.step;
  ranks.on_root([&] { folder.cut_log(); });
  if (step >= scene.time.end_step && ranks.broadcast(says_finished(folder.path()))) {
    ranks.on_root([&] { tell_edited_scene(folder, scene, loaded, options, false); });
    if (options.notice)
      options.notice(fmt::format("the run in '{}' is finished, nothing was changed; --until with a later orbit than "
                                 "{:.6g} goes on",
                                 options.folder.string(), static_cast<double>(step) * scene.time.step));
    RunResult result{true, step, state_hash(loaded.run.state, scene, ranks), resume_command(options)};
    ranks.on_root([&] { result.summary = read_summary(options.folder); });
    return result;
  }
  Simulation simulation(scene, std::move(loaded.run.state), ranks);
  ranks.on_root([&] {
    tell_edited_scene(folder, scene, loaded, options, true);
    folder.cut_snapshots(loaded.counters.snapshots);
    folder.remove_summary();
    prune_checkpoints(newest);
  });
  Recorder recorder(folder, lock ? &*lock : nullptr, scene, options.arguments, loaded.counters, step, options.notice,
                    ranks);
  recorder.tell_losses();
  recorder.log("resumed", {{"checkpoint", newest.filename().string()},
                           {"step", step},
                           {"orbits", simulation.orbits()},
                           {"end_orbits", end_orbits(scene)},
                           {"threads", threads()},
                           {"ranks", ranks.size()}});
  return carry_on(scene, options, requests, folder, simulation, recorder, start);
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
  tell_edited_scene(RunFolder(folder), loaded.run.scene, loaded, options, false);
  return std::move(loaded.run);
}

void store_checkpoint(const std::filesystem::path& file, const SimulationState& state, const Scene& scene) {
  OutputCounters counters;
  FieldTable table = state.fields();
  counters.list_fields(table, scene);
  write_checkpoint(file, table, {scene.resolved, collect_provenance({})});
}

RunResult start_run(const Scene& scene, const RunOptions& options, RunRequests& requests) {
  return with_advice(options, [&] { return begin(scene, options, requests); });
}

RunResult resume_run(const RunOptions& options, RunRequests& requests) {
  return with_advice(options, [&] { return go_on(options, requests); });
}

} // namespace keeler
