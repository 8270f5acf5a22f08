// keeler tile: repeats a snapshot into a larger patch, and writes it as a snapshot.
#include "command.hpp"
#include "common_options.hpp"
#include "print.hpp"
#include "results.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/format.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/tiled.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <string>
#include <vector>

namespace keeler::cli {
namespace {

struct TileOptions {
  std::string file, output;
  std::size_t nx = 1, ny = 1;
  bool force = false;
  ThreadOption threads;
};

// Writes the tiled patch in pieces, so that it is never whole in memory.
void write(const initial_conditions::TiledPatch& tiled, const std::string& file, const io::SnapshotMeta& meta) {
  const Patch frame = tiled.some(0, 0);
  io::SnapshotFile snapshot(file, frame, tiled.size(), tiled.rough(), meta);
  for (std::size_t first = 0; first < tiled.size(); first += io::SnapshotFile::piece)
    snapshot.add(tiled.some(first, std::min(io::SnapshotFile::piece, tiled.size() - first)));
  snapshot.finish();
}

ExitCode tile(const TileOptions& options, const std::vector<std::string>& arguments) {
  assert(options.nx > 0 && options.ny > 0);
  options.threads.apply();
  files::refuse_stream(output_named(options.output), "HDF5");
  require_new_file(options.output, options.force, "a state");
  io::Snapshot snapshot = io::read_snapshot(options.file);
  // The scene cannot reproduce this state, so the scene in the snapshot starts from the file, with all particles.
  const Scene scene = parse_scene(snapshot.meta.scene, options.file, {"start.keep_fraction=1.0"}, options.output);
  const Patch patch = initial_conditions::patch_from_snapshot(std::move(snapshot.patch), options.file, scene);
  cells::require_no_overlap(patch, "'" + options.file + "'");
  const initial_conditions::TiledPatch tiled(patch, options.nx, options.ny);
  write(tiled, options.output, {scene.resolved, io::collect_provenance(arguments)});
  const ShearingBox box = tiled.some(0, 0).box;
  print("{} in {} m x {} m, {} x {} copies of {}: {}\n", pluralize(tiled.size(), "particle"),
        format_number(box.size_x, 5), format_number(box.size_y, 5), options.nx, options.ny, options.file,
        options.output);
  return ExitCode::done;
}

} // namespace

void add_tile(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  const auto options = std::make_shared<TileOptions>();
  CLI::App& command = *program.add_subcommand("tile", "repeat a snapshot into a larger patch");
  command.add_option("FILE", options->file, "the snapshot to repeat")->required()->type_name("");
  const auto copies = whole_number_between(1, 10000, "a number of copies");
  command.add_option("NX", options->nx, "copies side by side along the radius")
      ->required()
      ->type_name("")
      ->transform(copies);
  command.add_option("NY", options->ny, "copies side by side along the orbit")
      ->required()
      ->type_name("")
      ->transform(copies);
  command.add_option("-o,--output", options->output, "the snapshot to write; give it the ending .hdf")
      ->required()
      ->type_name("FILE");
  command.add_flag("--force", options->force, "replace the file if it exists");
  options->threads.add_to(command);
  examples_of(command, {"keeler tile wakes/snap_000030.hdf 3 3 -o large.hdf"});
  command.callback(
      [options, arguments, &action] { action = [options, arguments] { return tile(*options, arguments); }; });
}

} // namespace keeler::cli
