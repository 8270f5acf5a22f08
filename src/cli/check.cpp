// keeler check: what a scene means, before anything runs.
#include "command.hpp"
#include "print.hpp"
#include "scene_arguments.hpp"

#include <keeler/bench/yardsticks.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/core/words.hpp>
#include <keeler/scene/derived.hpp>
#include <keeler/scene/doubts.hpp>
#include <keeler/scene/estimate.hpp>
#include <keeler/scene/grain_piles.hpp>
#include <keeler/scene/resting_choice.hpp>
#include <keeler/states/initial.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keeler {
namespace {

struct CheckOptions {
  SceneArguments scene;
  bool json = false;
  bool defaults = false;
  bool markdown = false;
};

// Of a scene with self-gravity and a fixed step.
double kick_interval_orbits(const Scene& scene) {
  return scene.time.step * static_cast<double>(scene.gravity->kick_every);
}

using Lines = std::vector<std::string>;

// How large the patch of a start file is, and of what density, is known to it alone.
PatchScale scale_of_start(const Scene& scene) {
  return scene.start_from ? scale_of(initial_patch(scene)) : scale_of(scene);
}

// None when only a start file knows the particles.
std::optional<RunEstimate> estimate(const Scene& scene, const Derived& d) {
  if (!d.particles_known)
    return std::nullopt;
  set_threads(1);
  return estimate_run(scene, pair_yardstick(cpu_seconds));
}

nlohmann::ordered_json as_json(const RunEstimate& estimate, const Scene& scene) {
  nlohmann::ordered_json json;
  for (const RunEstimate::Part& part : estimate.parts())
    json[fmt::format("{}_s", part.name)] = part.seconds;
  json["dominates"] = estimate.dominating();
  json["contacts_per_particle_orbit"] = scene_contacts(scene).wakes.all();
  json["grains_in_piles"] = GrainPiles(scene).grains(static_cast<double>(scene.time.end_step) * scene.time.step);
  return json;
}

// Of a scene whose particles attract each other.
const char* resting_word(const Scene& scene) {
  return scene.gravity->carries() ? "carried" : "bounced";
}

// Numbers that only the start file knows are null.
nlohmann::ordered_json as_json(const Scene& scene, const Derived& d, const std::optional<RunEstimate>& cost,
                               const Lines& said) {
  const auto known = [&](double value) -> nlohmann::ordered_json {
    return d.particles_known ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json;
  json["title"] = scene.title;
  json["particle_count"] = d.particles_known ? nlohmann::ordered_json(d.particle_count) : nlohmann::ordered_json();
  json["optical_depth"] = known(d.optical_depth);
  json["surface_density"] = known(d.surface_density);
  json["lambda_cr_m"] = known(d.lambda_cr);
  json["toomre_q"] = known(d.toomre_q);
  json["hill_parameter"] = known(d.hill_parameter);
  json["midplane_filling"] = known(d.midplane_filling);
  json["box_m"] = {known(scene.size_x), known(scene.size_y)};
  json["steps"] = d.steps;
  json["step_orbits"] = scene.time.automatic ? nlohmann::ordered_json() : nlohmann::ordered_json(scene.time.step);
  json["kick_interval_orbits"] = scene.gravity && !scene.time.automatic
                                     ? nlohmann::ordered_json(kick_interval_orbits(scene))
                                     : nlohmann::ordered_json();
  json["resting_contacts"] = scene.gravity && scene.gravity->by_pairs() ? nlohmann::ordered_json(resting_word(scene))
                                                                        : nlohmann::ordered_json();
  json["memory_mb"] = known(d.memory_mb);
  json["estimated_s"] = cost ? nlohmann::ordered_json(cost->total()) : nlohmann::ordered_json();
  json["estimate"] = cost ? as_json(*cost, scene) : nlohmann::ordered_json();
  json["notices"] = scene.notices;
  json["doubts"] = said;
  json["costs"] = d.particles_known ? dear_choices(scene) : std::vector<std::string>();
  return json;
}

std::string duration(double seconds) {
  if (seconds < 120.0)
    return figures(seconds, 2) + " s";
  return seconds < 7200.0 ? fmt::format("{:.0f} min", seconds / 60.0) : fmt::format("{:.1f} h", seconds / 3600.0);
}

void print_particles(const Scene& scene, const Derived& d) {
  print("box                {} m x {} m", figures(scene.size_x, 4), figures(scene.size_y, 4));
  print(" ({:.2f} x {:.2f} lambda_cr)\n", scene.size_x / d.lambda_cr, scene.size_y / d.lambda_cr);
  print("particles          {}\n", d.particle_count);
  print("optical depth      {}\n", figures(d.optical_depth, 4));
  print("surface density    {} kg/m^2\n", figures(d.surface_density, 4));
  print("lambda_cr          {} m\n", figures(d.lambda_cr, 4));
  print("Toomre Q           {} at the start\n", figures(d.toomre_q, 3));
  print("Hill parameter r_h {:.3g}\n", d.hill_parameter);
  print("mid-plane filling  {:.3g} at the start\n", d.midplane_filling);
}

void print_estimate(const RunEstimate& cost) {
  std::string parts;
  for (const RunEstimate::Part& part : cost.parts())
    if (part.seconds > 0.0)
      parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", part.name, duration(part.seconds));
  print("time               about {} on one thread (an estimate): {}; {} dominates\n", duration(cost.total()), parts,
        cost.dominating());
}

void print_steps(const Scene& scene, const Derived& d) {
  if (scene.time.automatic)
    print("steps              automatic, from 1/{} to 1/{} orbits\n", TimeSettings::ticks_per_orbit,
          TimeSettings::ticks_per_orbit / TimeSettings::longest);
  else
    print("steps              {} of {} orbits\n", d.steps, figures(scene.time.step));
  if (!scene.gravity)
    return;
  print("gravity            {}",
        in_words(d.particles_known ? chosen_for(d.particle_count, *scene.gravity) : *scene.gravity));
  if (scene.time.automatic)
    print("\n");
  else
    print("; a kick each {} orbits\n", figures(kick_interval_orbits(scene)));
}

void print_bodies(const Scene& scene) {
  const double g = newton_g(scene.planet.orbital_frequency);
  for (std::size_t k = 0; k < scene.particles.aggregates.size(); ++k) {
    const AggregateSettings& a = scene.particles.aggregates[k];
    print("aggregate {:<8} ids {} to {}, radius {} m, mass {} kg, Hill radius {} m\n", k + 1, a.first,
          a.first + a.count - 1, figures(a.radius, 4), figures(a.mass, 4), figures(std::cbrt(g * a.mass / 3.0), 3));
  }
  for (std::size_t k = 0; k < scene.moonlets.size(); ++k) {
    const MoonletSettings& m = scene.moonlets[k];
    print("moonlet {:<10} id {}, radius {} m, mass {} kg, Hill radius {} m\n", k + 1, scene.particles.count + k,
          figures(m.radius), figures(m.mass, 4), figures(std::cbrt(g * m.mass / 3.0), 3));
  }
}

void print_start(const Scene& scene, const PatchScale& start) {
  print("box and particles  from {}\n", *scene.start_from);
  print("optical depth      {}\n", figures(start.optical_depth, 4));
  print("Hill parameter r_h {:.3g} of its particles\n",
        hill_parameter(start.density, distance_from_saturn(scene.planet)));
}

// What the default would be, and why, stands beside a choice of the scene's own.
void print_resting_contacts(const Scene& scene, const PatchScale& start) {
  if (!scene.gravity || !scene.gravity->by_pairs())
    return;
  const RestingChoice choice = choose_resting_contacts(start, scene);
  const char* const otherwise = choice.carried ? "by default they are carried: " : "by default they bounce: ";
  print("contacts at rest   {} ({}{})\n", resting_word(scene),
        choice.carried == scene.gravity->carries() ? "" : otherwise, choice.reason);
}

void print_text(const Scene& scene, const Derived& d, const std::optional<RunEstimate>& cost, const PatchScale& start,
                const Lines& said) {
  if (!scene.title.empty())
    print("{}\n", scene.title);
  if (scene.start_from)
    print_start(scene, start);
  else
    print_particles(scene, d);
  print_bodies(scene);
  print_steps(scene, d);
  print_resting_contacts(scene, start);
  if (d.particles_known)
    print("memory             about {:.0f} MB (an estimate)\n", d.memory_mb);
  if (cost)
    print_estimate(*cost);
  for (const std::string& notice : scene.notices)
    print("note: {}\n", notice);
  for (const std::string& doubt : said)
    print("note: {}\n", doubt);
  if (d.particles_known)
    for (const std::string& line : dear_choices(scene))
      print("note: {}\n", line);
}

ExitCode check(const CheckOptions& options) {
  if (options.defaults) {
    print("{}", describe_keys(options.markdown));
    return ExitCode::done;
  }
  if (options.scene.path.empty())
    throw UsageError("check needs a scene (there is nothing to check); write keeler check SCENE, or --defaults");
  const Scene asked = options.scene.load();
  require_start_file(asked);
  const PatchScale start = scale_of_start(asked);
  const Scene scene = decided_by(asked, start);
  Lines said = doubts(scene, start);
  const Derived derived = derive(scene);
  if (const double left = 1e-6 * available_memory(); derived.memory_mb > left)
    said.push_back(fmt::format("the run needs about {} GB of memory, and {} GB can be had here: run refuses it; take "
                               "fewer particles, a coarser mesh, or a machine that has more",
                               figures(1e-3 * derived.memory_mb, 3), figures(1e-3 * left, 3)));
  const std::optional<RunEstimate> cost = estimate(scene, derived);
  if (options.json)
    print("{}\n", json_text(as_json(scene, derived, cost, said), 2));
  else
    print_text(scene, derived, cost, start, said);
  return ExitCode::done;
}

} // namespace

void add_check(CLI::App& program, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App& command = *program.add_subcommand("check", "validate a scene and print what follows from it; runs nothing");
  options->scene.add_to(command);
  command.add_flag("--json", options->json, "print the numbers as JSON");
  CLI::Option* defaults =
      command.add_flag("--defaults", options->defaults, "print every key with its default, unit and meaning");
  command.add_flag("--markdown", options->markdown, "print the keys as the manual's table")->needs(defaults);
  examples_of(command, {"keeler check scene.toml", "keeler check scene.toml --set particles.optical_depth=0.8",
                        "keeler check --defaults"});
  command.callback([options, &action] { action = [options] { return check(*options); }; });
}

} // namespace keeler
