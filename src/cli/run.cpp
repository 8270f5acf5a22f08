// keeler run and keeler resume.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "number_options.hpp"
#include "print_record.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

struct JobOptions {
  SceneArguments scene;
  std::string folder;
  std::optional<std::string> from;
  double until = 0.0, wall_time = 0.0;
  bool force = false, check = false, json = false;
  UnitsOption units;
  ThreadOption threads;
  TalkOption talk;
};

// Returns the options of the run. Only rank 0 gets functions for progress and notices.
runs::RunOptions run_options(const JobOptions& job, const std::vector<std::string>& arguments, ProgressLine& line,
                             const Communicator& ranks) {
  runs::RunOptions options;
  options.ranks = ranks;
  options.folder = job.folder;
  options.force = job.force;
  options.check = job.check;
  if (job.wall_time > 0.0)
    options.wall_time_s = job.wall_time;
  if (job.until > 0.0)
    options.until_orbits = job.until;
  options.arguments = arguments;
  if (!ranks.is_root())
    return options;
  options.start_progress = [&line](const initial_conditions::StartProgress& progress) { line.show(progress); };
  options.progress = [&line](const runs::RunProgress& progress) { line.show(progress); };
  options.notice = job.talk.notice();
  return options;
}

ExitCode report(const JobOptions& job, const runs::RunResult& result, const Communicator& ranks) {
  if (!ranks.is_root())
    return result.finished ? ExitCode::done : ExitCode::stopped;
  print_record(result.summary, job.json, job.units.system());
  if (!job.json)
    print("{:<34} {}\n", "folder", job.folder);
  if (result.finished)
    return ExitCode::done;
  say(fmt::format("stopped at step {} with a checkpoint; continue with \"{}\"", result.step, result.resume_command));
  return ExitCode::stopped;
}

void add_common(CLI::App& command, JobOptions& job) {
  command.add_option("--wall-time", job.wall_time, "stop with a checkpoint before this many seconds have passed")
      ->check(positive_number());
  command.add_flag("--check", job.check, "check all invariants in every step; slower, with identical results");
  command.add_flag("--json", job.json, "print the summary as JSON");
  job.units.add_to(command);
  job.threads.add_to(command);
  job.talk.add_to(command);
}

} // namespace

void add_run(CLI::App& program, Action& action, const std::vector<std::string>& arguments, const Communicator& ranks) {
  const auto job = std::make_shared<JobOptions>();
  CLI::App& command = *program.add_subcommand("run", "evolve a scene into a folder of results");
  job->scene.add_to(command)->required();
  command.add_option("-o,--output", job->folder, "the folder for the results; created if absent")
      ->required()
      ->type_name("DIR");
  command.add_option("--from", job->from, "start from the particles and the box of this snapshot")->type_name("FILE");
  command.add_flag("--force", job->force, "replace the run in the folder");
  add_common(command, *job);
  examples_of(command,
              {"keeler run scene.toml -o wakes", "keeler run scene.toml --set time.end=10 --threads 4 -o longer",
               "keeler run scene.toml --from start.hdf -o wakes"});
  command.callback([job, arguments, ranks, &action] {
    requests_from_signals(); // before signals are released
    action = [job, arguments, ranks] {
      job->threads.apply();
      if (ranks.is_root())
        job->talk.say_program();
      Scene scene;
      ranks.together([&] {
        require_folder_name(job->folder);
        scene = job->scene.load(job->from);
      });
      if (ranks.is_root())
        job->talk.say_scene(scene);
      runs::RunResult result;
      {
        ProgressLine line(job->talk);
        result = start_run(scene, run_options(*job, arguments, line, ranks), requests_from_signals());
      }
      return report(*job, result, ranks);
    };
  });
}

void add_resume(CLI::App& program, Action& action, const std::vector<std::string>& arguments,
                const Communicator& ranks) {
  const auto job = std::make_shared<JobOptions>();
  CLI::App& command = *program.add_subcommand("resume", "continue a run from its newest whole checkpoint");
  command.add_option("DIR", job->folder, "the folder of the run")->required()->type_name("");
  command.add_option("--until", job->until, "new end of the run, in orbits since its begin")->check(positive_number());
  add_common(command, *job);
  examples_of(command, {"keeler resume wakes", "keeler resume wakes --until 20"});
  command.callback([job, arguments, ranks, &action] {
    requests_from_signals(); // before signals are released
    action = [job, arguments, ranks] {
      job->threads.apply();
      if (ranks.is_root())
        job->talk.say_program();
      runs::RunResult result;
      {
        ProgressLine line(job->talk);
        result = resume_run(run_options(*job, arguments, line, ranks), requests_from_signals());
      }
      return report(*job, result, ranks);
    };
  });
}

} // namespace keeler::cli
