// keeler generate: writes an initial state, of a scene or of a table of particles, as a snapshot in double precision.
#include "command.hpp"
#include "common_options.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/format.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/initial_conditions/broken.hpp>
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/initial_conditions/from_table.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/load_parts.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace keeler::cli {
namespace {

struct GenerateOptions {
  SceneArguments scene;
  std::string output;
  std::string table;
  bool clumped = false, relax = false, force = false;
  initial_conditions::SettleCriterion criterion;
  ThreadOption threads;
  TalkOption talk;
};

constexpr const char* stopped =
    "stopped before the state was complete (on request), so no state is written; start again, or "
    "use \"keeler run\", which writes checkpoints";

Patch make_patch(const Scene& scene, const TalkOption& talk) {
  ProgressLine line(talk);
  return initial_patch(scene, [&line](const initial_conditions::StartProgress& progress) { line.show(progress); });
}

// Returns the name for a broken state, in the folder of the requested output.
std::filesystem::path broken_name(const std::filesystem::path& output, std::int64_t step) {
  return output.parent_path() / fmt::format("{}_broken_{:06}.hdf", output.stem().string(), step);
}

initial_conditions::ClumpedState evolve_until_clumped(const Scene& scene, const GenerateOptions& options,
                                                      const io::SnapshotMeta& meta) {
  ProgressLine line(options.talk);
  try {
    return clumped_state(scene, options.criterion,
                         [&line](const initial_conditions::ClumpingProgress& progress) { line.show(progress); });
  } catch (const initial_conditions::BrokenState& broken) {
    throw InvariantError(save_broken(broken, broken_name(options.output, broken.step), meta));
  }
}

void print_means(const char* name, const char* unit, const initial_conditions::WindowMeans& means,
                 const initial_conditions::MeanBounds& bounds, double in_unit) {
  print("{}: {:.4g} ± {:.2g} {}, {:.4g} ± {:.2g} before: changes by {:.1f} % (at most {:.1f} %), errors up to "
        "{:.1f} % (at most {:g} %)\n",
        name, in_unit * means.last.value, in_unit * means.last.error, unit, in_unit * means.before.value,
        in_unit * means.before.error, 100.0 * means.change(), 100.0 * means.tolerance, 100.0 * means.error(),
        100.0 * bounds.error);
}

void print_clumping(const initial_conditions::Clumping& c) {
  const initial_conditions::Settling& s = c.settling;
  print("settled after {:.4g} orbits, by means over the last {} orbits and the {} before, after orbit {:g}\n", c.orbits,
        s.window_orbits, s.window_orbits, c.criterion.first_orbit);
  print_means("viscosity from the loss of energy", "m²/s", s.viscosity, c.criterion.viscosity, c.orbital_frequency);
  print_means("wake length lambda_perp", "m", s.wavelength, c.criterion.wavelengths, 1.0);
  print_means("wake length lambda_x", "m", s.radial_wavelength, c.criterion.wavelengths, 1.0);
  print("contrast: {:.3g}; this state differs by {:.1f} % (at most {:g} %)\n", s.contrast, 100.0 * s.deviation,
        100.0 * c.criterion.largest_deviation);
}

void require_output(const GenerateOptions& options) {
  files::refuse_stream(output_named(options.output), "HDF5");
  for (const std::string& source : {options.scene.path, options.table})
    refuse_own_source(options.output, source);
  require_new_file(options.output, options.force, "a state");
}

void print_warnings(const Scene& scene, const Patch& patch, const TalkOption& talk) {
  if (talk.quiet)
    return;
  for (const std::string& warning : advice::warnings(scene, initial_conditions::scale_of(patch)))
    print("note: {}\n", warning);
}

// Removes overlaps that a run would refuse if --relax is given, otherwise reports them. Throws InvariantError.
void remove_overlaps(Patch& patch, const GenerateOptions& options, const io::ParticleTable& table) {
  const std::size_t overlaps = cells::count_overlaps(patch, cells::allowed_overlap);
  if (overlaps == 0)
    return;
  const cells::Overlap worst = cells::largest_overlap(patch);
  const std::string found = fmt::format("{} of particles overlap, most of all {} and {}, by {:.2g} of their radius sum",
                                        pluralize(overlaps, "pair"), table.location_of(worst.id_i),
                                        table.location_of(worst.id_j), worst.depth);
  if (!options.relax)
    throw InvariantError(found + initial_conditions::overlap_hint(patch) +
                         "; correct them, or move them apart with --relax");
  const initial_conditions::Relaxation moved =
      unless_stopped(stopped, [&] { return initial_conditions::relax(patch); });
  print("{}; moved {} apart, by {} m at most\n", found, pluralize(moved.moved, "particle"),
        format_number(moved.farthest, 3));
}

void print_state(const Patch& patch, const std::string& output) {
  print("{} in {} m x {} m, no overlaps: {}\n", pluralize(patch.size(), "particle"), format_number(patch.box.size_x, 5),
        format_number(patch.box.size_y, 5), output);
}

ExitCode generate_from_table(const GenerateOptions& options, const std::vector<std::string>& arguments) {
  const scene::TableScene of = scene::load_table_scene(options.scene.path, options.scene.overrides);
  require_output(options);
  const io::ParticleTable table = io::read_particle_table(options.table);
  Patch patch = initial_conditions::patch_from_table(table, of);
  remove_overlaps(patch, options, table);
  for (const std::string& notice : of.scene.notices)
    options.talk.notice()("note: " + notice);
  if (table.velocities.empty())
    options.talk.notice()("note: the table has no velocities: all orbits are circular");
  // The scene cannot reproduce this state, so the scene in the snapshot starts from the file.
  const Scene scene = decided_by(parse_scene(of.scene.resolved, options.scene.path, {}, options.output),
                                 initial_conditions::scale_of(patch));
  print_warnings(scene, patch, options.talk);
  io::write_snapshot(options.output, patch, {scene.resolved, io::collect_provenance(arguments)});
  print_state(patch, options.output);
  return ExitCode::done;
}

ExitCode generate(const GenerateOptions& options, const std::vector<std::string>& arguments) {
  options.threads.apply();
  options.talk.say_program();
  if (!options.table.empty())
    return generate_from_table(options, arguments);
  const Scene scene = options.scene.load();
  options.talk.say_scene(scene);
  require_output(options);
  io::SnapshotMeta meta{scene.resolved, io::collect_provenance(arguments)};
  Patch patch;
  if (options.clumped) {
    initial_conditions::ClumpedState state =
        unless_stopped(stopped, [&] { return evolve_until_clumped(scene, options, meta); });
    patch = std::move(state.patch);
    meta.clumping = clumping_numbers(state.clumping);
    print_clumping(state.clumping);
  } else {
    patch = unless_stopped(stopped, [&] { return make_patch(scene, options.talk); });
  }
  for (const std::string& notice : scene.notices)
    options.talk.notice()("note: " + notice);
  print_warnings(scene, patch, options.talk);
  meta.scene = decided_by(scene, initial_conditions::scale_of(patch)).resolved;
  write_snapshot(options.output, patch, meta);
  print_state(patch, options.output);
  return ExitCode::done;
}

} // namespace

void add_generate(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  const auto options = std::make_shared<GenerateOptions>();
  CLI::App& command = *program.add_subcommand("generate", "write the initial state of a scene as a snapshot");
  options->scene.add_to(command)->required();
  command.add_option("-o,--output", options->output, "the snapshot to write; give it the ending .hdf")
      ->required()
      ->type_name("FILE");
  CLI::Option& clumped = *command.add_flag("--clumped", options->clumped,
                                           "evolve the state under its own gravity until its wakes have settled");
  command
      .add_option("--most-orbits", options->criterion.max_orbits,
                  "give up if wakes have not settled by then (default: 30)")
      ->check(number_between(0.0, 200.0, "a number of orbits"))
      ->needs(&clumped);
  CLI::Option& table =
      *command.add_option("--from-table", options->table,
                          "take the particles from this table (CSV, HDF5, npz, extended XYZ or GADGET), in the "
                          "scene's box");
  table.excludes(&clumped)->type_name("FILE");
  command.add_flag("--relax", options->relax, "move overlapping particles of the table apart")->needs(&table);
  command.add_flag("--force", options->force, "replace the file if it exists");
  options->threads.add_to(command);
  options->talk.add_to(command);
  examples_of(command,
              {"keeler generate scene.toml -o start.hdf", "keeler generate scene.toml --clumped -o wakes.hdf"});
  command.callback(
      [options, arguments, &action] { action = [options, arguments] { return generate(*options, arguments); }; });
}

} // namespace keeler::cli
