// keeler run and keeler resume: the main job.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <keeler/core/words.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>
#include <optional>

namespace keeler {
namespace {

struct JobOptions {
  SceneArguments scene;
  std::string folder;
  std::optional<std::string> from;
  double until = 0.0, wall_time = 0.0;
  bool force = false, check = false, json = false;
  ThreadOption threads;
  TalkOption talk;
};

// The first rank alone speaks.
RunOptions run_options(const JobOptions& job, const std::vector<std::string>& arguments, ProgressLine& line,
                       const Ranks& ranks) {
  RunOptions options;
  options.ranks = ranks;
  options.folder = job.folder;
  options.force = job.force;
  options.check = job.check;
  if (job.wall_time > 0.0)
    options.wall_time_s = job.wall_time;
  if (job.until > 0.0)
    options.until_orbits = job.until;
  options.arguments = arguments;
  if (!ranks.is_first())
    return options;
  options.start_progress = [&line](const StartProgress& progress) { line.show(progress); };
  options.progress = [&line](const RunProgress& progress) { line.show(progress); };
  options.notice = job.talk.notice();
  return options;
}

// Of a run with self-gravity: what rests, or bounces where it may have to rest. How much a share of unresolved contacts
// loses depends on the kick interval too (docs/hard-spheres.md), so the balance of energy decides.
void print_contacts_at_rest(const nlohmann::json& s) {
  constexpr double too_many = 0.1;
  const double unresolved = s["unresolved_contacts_share"].get<double>();
  if (const nlohmann::json& resting = s["resting_contacts"]; !resting.is_null())
    print("contacts at rest                    {} carry the kicks of gravity now\n",
          counted(resting.get<std::uint64_t>(), "pair"));
  else if (unresolved > too_many)
    print("contacts at rest                    {} % of the contacts are slower than one kick of the pair's own "
          "gravity: where the energy balance is above 1, set gravity.resting_contacts to \"carried\", or kick more "
          "often\n",
          figures(100.0 * unresolved, 2));
}

void print_summary(const std::string& folder, const nlohmann::json& s) {
  const auto number = [&](const char* key) { return s[key].get<double>(); };
  const auto count = [&](const char* key, const char* noun) { return counted(s[key].get<std::uint64_t>(), noun); };
  print("{} orbits, {}, {}, {}\n", figures(number("time_orbits")), count("steps", "step"),
        count("particle_count", "particle"), count("threads", "thread"));
  print("collisions per particle and orbit   {} faster than v_cut, {} slow contacts\n",
        figures(number("collisions_per_particle_orbit"), 3), figures(number("slow_contacts_per_particle_orbit"), 3));
  print_contacts_at_rest(s);
  print("largest overlap                     {} of a radius sum\n", figures(number("largest_overlap"), 2));
  if (s["finder_gave_up"].get<long>() > 0 || number("largest_overlap") > 1e-8)
    print("the collision finder                gave up on {}, and may have missed contacts\n",
          s["finder_gave_up"].get<long>() == 1 ? "1 search"
                                               : fmt::format("{} searches", s["finder_gave_up"].get<long>()));
  constexpr double left_out = 0.05; // no solver of all forces errs as much
  if (const nlohmann::json& f = s["force_error"]; !f.is_null() && f["rms"].get<double>() > left_out)
    print("left out of gravity                 {} % of the rms acceleration, by choice: a mesh alone has no pull of "
          "neighbours, rings of images none from beyond, and few particles feel little else\n",
          figures(100.0 * f["rms"].get<double>(), 2));
  else if (!f.is_null())
    print("error of gravity                    {:.1e} of the rms acceleration, at worst {:.1e} (rms of {}, {})\n",
          f["rms"].get<double>(), f["worst_rms"].get<double>(),
          counted(f["particles"].get<std::uint64_t>(), "particle"), counted(f["checks"].get<std::uint64_t>(), "check"));
  const nlohmann::json& e = s["energy_j"];
  const auto energy = [&](const char* key) { return e[key].get<double>(); };
  const auto joules = [&](const char* key) { return figures(energy(key), 4); };
  print("energy of random motion (J)         change {} = shear by transport {} + by contacts {} + kicks {}{} - "
        "collisions {}, rounding {:.1e}\n",
        figures(energy("now") - energy("start"), 4), joules("translational_shear_work"),
        joules("collisional_shear_work"), joules("kick_work"),
        energy("resting_work") == 0.0 ? "" : fmt::format(" + contacts at rest {}", joules("resting_work")),
        joules("lost_in_collisions"), energy("residual"));
  const auto known = [](const nlohmann::json& b) { // better than by its own size
    return !b.is_null() && b["ratio"].is_number() &&
           (!b["error"].is_number() || b["error"].get<double>() < std::fabs(b["ratio"].get<double>()));
  };
  if (const nlohmann::json& b = s["energy_balance"]; known(b))
    print("energy balance                      {:.3f}{}: energy lost over the work of the shear, orbits {} to {}{}\n",
          b["ratio"].get<double>(), b["error"].is_number() ? fmt::format(" +- {:.1g}", b["error"].get<double>()) : "",
          figures(b["since_orbit"].get<double>(), 4), figures(b["until_orbit"].get<double>(), 4),
          b["steady"].get<bool>() ? "" : ", not steady");
  const nlohmann::json& split = s["split"];
  const auto part = [&](const char* key) { return split.value(key, 0.0); };
  print("time                                {:.1f} s wall, {:.1f} s processor: start {:.1f} s, drift {:.1f} s, "
        "gravity {:.1f} s\n",
        number("wall_s"), number("cpu_s"), part("start_s"), part("drift_s"), part("gravity_s"));
  print("time of output                      series {:.2g} s, stresses {:.2g} s, snapshots {:.2g} s, "
        "checkpoints {:.2g} s, checks of forces {:.2g} s\n",
        part("series_s"), part("stresses_s"), part("snapshots_s"), part("checkpoints_s"), part("force_checks_s"));
  if (const std::uint64_t ranks = s["ranks"].get<std::uint64_t>(); ranks > 1)
    print("exchange of ranks                   {:.1f} s of the first of {}: sending, receiving, waiting for others\n",
          part("exchange_s"), ranks);
  const nlohmann::json& cost = s["ns_per_particle_step"];
  print("ns per particle and step            drift {:.0f}, gravity {:.0f}, series {:.1f}\n", cost.value("drift", 0.0),
        cost.value("gravity", 0.0), cost.value("series", 0.0));
  for (const nlohmann::json& note : s["notes"])
    print("note                                {}\n", note.get<std::string>());
  print("state                               {}\n", s["state_hash"].get<std::string>());
  print("folder                              {}\n", folder);
}

ExitCode report(const JobOptions& job, const RunResult& result, const Ranks& ranks) {
  if (!ranks.is_first())
    return result.finished ? ExitCode::done : ExitCode::stopped;
  const std::string text = read_text(std::filesystem::path(job.folder) / "summary.json");
  if (job.json)
    print("{}", text);
  else
    print_summary(job.folder, nlohmann::json::parse(text));
  if (result.finished)
    return ExitCode::done;
  say(fmt::format("stopped at step {} with a checkpoint; continue with \"{}\"", result.step, result.resume_command));
  return ExitCode::stopped;
}

void add_common(CLI::App& command, JobOptions& job) {
  command.add_option("--wall-time", job.wall_time, "stop with a checkpoint before this many seconds have passed")
      ->check(positive_number());
  command.add_flag("--check", job.check, "hold each step against all invariants; slower, and the results are the same");
  command.add_flag("--json", job.json, "print the summary as JSON");
  job.threads.add_to(command);
  job.talk.add_to(command);
}

} // namespace

void add_run(CLI::App& program, Action& action, const std::vector<std::string>& arguments, const Ranks& ranks) {
  const auto job = std::make_shared<JobOptions>();
  CLI::App& command = *program.add_subcommand("run", "evolve a scene into a folder of results");
  job->scene.add_to(command)->required();
  command.add_option("-o,--output", job->folder, "the folder for the results; made if absent")
      ->required()
      ->type_name("DIR");
  command.add_option("--from", job->from, "start from the particles and the box of this snapshot")->type_name("FILE");
  command.add_flag("--force", job->force, "replace the run that the folder holds");
  add_common(command, *job);
  examples_of(command,
              {"keeler run scene.toml -o wakes", "keeler run scene.toml --set time.end=10 --threads 4 -o longer",
               "keeler run scene.toml --from start.hdf -o wakes"});
  command.callback([job, arguments, ranks, &action] {
    requests_from_signals(); // before signals are released
    action = [job, arguments, ranks] {
      job->threads.apply();
      if (ranks.is_first())
        job->talk.say_program();
      Scene scene;
      ranks.together([&] {
        require_folder_name(job->folder);
        scene = job->scene.load(job->from);
      });
      if (ranks.is_first())
        job->talk.say_scene(scene);
      RunResult result;
      {
        ProgressLine line(job->talk);
        result = start_run(scene, run_options(*job, arguments, line, ranks), requests_from_signals());
      }
      return report(*job, result, ranks);
    };
  });
}

void add_resume(CLI::App& program, Action& action, const std::vector<std::string>& arguments, const Ranks& ranks) {
  const auto job = std::make_shared<JobOptions>();
  CLI::App& command = *program.add_subcommand("resume", "continue a run from its newest whole checkpoint");
  command.add_option("DIR", job->folder, "the folder of the run")->required()->type_name("");
  command.add_option("--until", job->until, "another end, in orbits since the run began")->check(positive_number());
  add_common(command, *job);
  examples_of(command, {"keeler resume wakes", "keeler resume wakes --until 20"});
  command.callback([job, arguments, ranks, &action] {
    requests_from_signals(); // before signals are released
    action = [job, arguments, ranks] {
      job->threads.apply();
      if (ranks.is_first())
        job->talk.say_program();
      RunResult result;
      {
        ProgressLine line(job->talk);
        result = resume_run(run_options(*job, arguments, line, ranks), requests_from_signals());
      }
      return report(*job, result, ranks);
    };
  });
}

} // namespace keeler
