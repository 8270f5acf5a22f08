// keeler tune: finds the cheapest settings of a scene within given tolerances.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/scene/quality.hpp>
#include <keeler/tune/tune.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cassert>
#include <memory>

namespace keeler::cli {
namespace {

struct TuneOptions {
  SceneArguments scene;
  tune::TuneSettings settings;
  std::string quality = scene::default_quality;
  std::optional<double> force_error, physics_error;
  std::optional<std::string> output;
  bool force = false, json = false;
  ThreadOption threads;
  TalkOption talk;
};

tune::TuneSettings tolerances(const TuneOptions& options) {
  tune::TuneSettings settings = options.settings;
  for (const scene::Quality& quality : scene::qualities)
    if (options.quality == quality.name) {
      settings.force_error = options.force_error.value_or(quality.force_error);
      settings.physics_error = options.physics_error.value_or(quality.physics_error);
    }
  return settings;
}

// True if the scene goes to standard output; then nothing else may be printed there.
bool fills_standard_output(const TuneOptions& options) {
  return options.output && is_standard_output(output_named(*options.output));
}

void require_writable_output(const TuneOptions& options) {
  if (!options.output)
    return;
  require_new_file(output_named(*options.output), options.force, "a scene");
  if (options.json && fills_standard_output(options))
    throw UsageError("--json and --output are both for standard output; name a file for the scene");
}

tune::Tuning measure(const Scene& scene, tune::TuneSettings settings, const TalkOption& talk) {
  ProgressLine line(talk);
  settings.progress = [&line](const Progress& progress) { line.show(progress); };
  return unless_stopped("stopped before all was measured (on request), so nothing is written",
                        [&] { return tune::tune(scene, settings); });
}

nlohmann::ordered_json as_json(const tune::Tuning& t, const std::vector<tune::ChosenKey>& keys) {
  nlohmann::ordered_json json;
  for (const tune::ChosenKey& key : keys)
    json["keys"][key.path] = key.value;
  assert(t.gravity.empty() || t.chosen_gravity < t.gravity.size());
  assert(t.kicks.empty() || t.chosen_kicks < t.kicks.size());
  json["particles"] = t.particles;
  json["orbits"] = t.orbits;
  json["gravity"] = nlohmann::ordered_json::array();
  for (const bench::GravityBenchRow& row : t.gravity)
    json["gravity"].push_back({{"solver", row.choice.solver},
                               {"settings", row.choice.text},
                               {"error_rms", row.errors.rms},
                               {"ns_per_particle", row.ns_per_particle}});
  json["kicks"] = nlohmann::ordered_json::array();
  for (const tune::KickProbe& probe : t.kicks)
    json["kicks"].push_back({{"kick_interval_orbits", probe.interval},
                             {"unresolved_contacts_share", probe.unresolved},
                             {"unresolved_contacts_share_error", probe.unresolved_error},
                             {"physics_error", probe.physics_error()}});
  json["steps"] = nlohmann::ordered_json::array();
  for (const tune::StepProbe& probe : t.steps)
    json["steps"].push_back({{"step_orbits", probe.step},
                             {"drifts_per_kick", probe.drifts},
                             {"contacts_per_particle_drift", probe.contacts},
                             {"processor_s_per_orbit", probe.seconds}});
  json["threads"] = nlohmann::ordered_json::array();
  for (const tune::ThreadProbe& probe : t.threads)
    json["threads"].push_back({{"threads", probe.threads}, {"speedup", probe.speedup}});
  json["chosen"] = {{"threads", t.chosen_threads},
                    {"error_rms", t.gravity.empty() ? nlohmann::ordered_json()
                                                    : nlohmann::ordered_json(t.gravity[t.chosen_gravity].errors.rms)},
                    {"physics_error", t.kicks.empty()
                                          ? nlohmann::ordered_json()
                                          : nlohmann::ordered_json(t.kicks[t.chosen_kicks].physics_error())},
                    {"processor_s", t.processor_seconds},
                    {"wall_s", t.wall_seconds}};
  return json;
}

const char* mark(bool chosen) {
  return chosen ? "  <-" : "";
}

void print_text(const tune::Tuning& t) {
  print("{} in states up to {:.3g} orbits old, one thread\n", pluralize(t.particles, "particle"), t.orbits);
  if (!t.gravity.empty())
    print("errors must be below {} of the tolerances, since seeds differ\n", tune::margin_for_seeds);
  if (!t.gravity.empty())
    print("\n{:<8}{:<22}{:>14}{:>18}\n", "solver", "settings", "force error", "ns per particle");
  for (std::size_t k = 0; k < t.gravity.size(); ++k)
    print("{:<8}{:<22}{:>14.1e}{:>18.0f}{}\n", t.gravity[k].choice.solver, t.gravity[k].choice.text,
          t.gravity[k].errors.rms, t.gravity[k].ns_per_particle, mark(k == t.chosen_gravity));
  if (!t.kicks.empty())
    print("\n{:<22}{:>22}{:>18}\n", "kick interval, orbits", "unresolved contacts", "error of the loss");
  for (std::size_t k = 0; k < t.kicks.size(); ++k)
    print("{:<22g}{:>22}{:>16.2g} %{}\n", t.kicks[k].interval,
          fmt::format("{:.2g} +- {:.1g} %", 100.0 * t.kicks[k].unresolved, 100.0 * t.kicks[k].unresolved_error),
          100.0 * t.kicks[k].physics_error(), mark(k == t.chosen_kicks));
  print("\n{:<16}{:>16}{:>28}{:>28}\n", "step, orbits", "drifts per kick", "contacts/(particle drift)",
        "processor s per orbit");
  for (std::size_t k = 0; k < t.steps.size(); ++k)
    print("{:<16g}{:>16}{:>28.2g}{:>28.3g}{}\n", t.steps[k].step, t.steps[k].drifts, t.steps[k].contacts,
          t.steps[k].seconds, mark(k == t.chosen_step));
  print("\n");
  for (const tune::ThreadProbe& probe : t.threads)
    if (probe.threads > 1)
      print("{}: {:.2f} times as fast{}\n", pluralize(probe.threads, "thread"), probe.speedup,
            mark(probe.threads == t.chosen_threads));
  print("the whole run: about {} processor seconds, {} s on {}\n\n", format_number(t.processor_seconds, 2),
        format_number(t.wall_seconds, 2), pluralize(t.chosen_threads, "thread"));
}

void print_keys(const std::vector<tune::ChosenKey>& keys) {
  for (const tune::ChosenKey& key : keys) {
    if (!key.comment.empty())
      print("# tune: {}\n", key.comment);
    print("{} = {}\n", key.path, key.value);
  }
}

void warn(const tune::Tuning& t) {
  if (!t.meets_force_error)
    say("no solver meets the force error with a margin for other seeds; the most accurate one is chosen");
  if (!t.meets_physics_error)
    say("no kick interval down to 1/1000 orbit meets the physics error with a margin for other seeds; this shortest "
        "one is chosen");
}

ExitCode tune_scene(const TuneOptions& options) {
  options.threads.apply();
  options.talk.say_program();
  tune::TuneSettings settings = tolerances(options);
  settings.max_threads = threads();
  const Scene scene = options.scene.load();
  for (const std::string& notice : scene.notices)
    options.talk.notice()("note: " + notice);
  require_writable_output(options);
  const tune::Tuning tuning = measure(scene, settings, options.talk);
  const std::vector<tune::ChosenKey> keys = chosen_keys(tuning, settings, scene);
  if (options.json)
    print("{}\n", json_text(as_json(tuning, keys), 2));
  else if (!fills_standard_output(options))
    print_text(tuning);
  if (!options.talk.quiet)
    warn(tuning);
  if (options.output) {
    files::write_text(output_named(*options.output), tuned_scene(scene, keys));
    if (!options.json)
      print_written(output_named(*options.output));
  } else if (!options.json) {
    print_keys(keys);
  }
  return ExitCode::done;
}

} // namespace

void add_tune(CLI::App& program, Action& action) {
  const auto options = std::make_shared<TuneOptions>();
  CLI::App& command = *program.add_subcommand(
      "tune", "find the cheapest solver, kick interval, step and threads within given tolerances, by probes on the "
              "scene's evolved state");
  options->scene.add_to(command)->required();
  std::vector<std::string> names;
  for (const scene::Quality& quality : scene::qualities)
    names.emplace_back(quality.name);
  one_of(command.add_option("--quality", options->quality, "set of tolerances (default: balanced)"), names);
  command
      .add_option("--force-error", options->force_error,
                  "largest rms error of gravity's forces, instead of the quality's")
      ->check(number_between(1e-5, 0.1, "a force error"));
  command
      .add_option("--physics-error", options->physics_error,
                  "largest error of the energy loss by kicks, instead of the quality's")
      ->check(number_between(1e-4, 0.5, "a physics error"));
  command
      .add_option("--orbits", options->settings.orbits,
                  "age of the probed state (default: 4 with self-gravity, otherwise 8; at most the run's end)")
      ->check(positive_number(max_orbits));
  command.add_option("-o,--output", options->output, "write the scene with the chosen keys")->type_name("FILE");
  command.add_flag("--force", options->force, "replace the file if it exists");
  command.add_flag("--json", options->json, "print the numbers as JSON");
  options->threads.add_to(command);
  options->talk.add_to(command);
  examples_of(command, {"keeler tune scene.toml -o tuned.toml"});
  command.callback([options, &action] { action = [options] { return tune_scene(*options); }; });
}

} // namespace keeler::cli
