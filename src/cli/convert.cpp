// keeler convert: writes the particles of snapshots, checkpoints and tables in the formats of other programs.
#include "command.hpp"
#include "common_options.hpp"
#include "print.hpp"
#include "results.hpp"
#include "signals.hpp"

#include <keeler/io/describe.hpp>
#include <keeler/io/particle_table.hpp>
#include <keeler/io/vtp.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string path, format;
  std::optional<std::string> output;
  bool force = false;

  const io::TableFormat& table_format() const { return io::table_format(format); }
};

io::ParticleTable table_in(const fs::path& file) {
  const std::optional<io::FileKind> kind = io::kind_of(file);
  if (!kind)
    return io::read_particle_table(file);
  switch (*kind) {
  case io::FileKind::snapshot:
    return io::table_of(runs::load_newest_patch(file).patches.back());
  case io::FileKind::checkpoint: {
    runs::StoredRun run = runs::load_checkpoint(file);
    return io::table_of(Simulation(run.scene, std::move(run.state)).patch());
  }
  case io::FileKind::contacts:
    break;
  }
  throw UsageError(fmt::format("'{}' is a file of contacts, which has no particles; name a snapshot or a checkpoint",
                               file.string()));
}

// Converts one file and returns its time, in orbits.
double convert_file(const fs::path& file, const fs::path& output, const ConvertOptions& options) {
  const io::ParticleTable table = table_in(file);
  options.table_format().write(output, table);
  return table.frame.time_orbits;
}

void convert_one(const ConvertOptions& options) {
  const fs::path file(options.path);
  const fs::path output = options.output
                              ? output_named(*options.output)
                              : output_beside(file, fs::path(file).replace_extension(options.table_format().ending));
  refuse_own_source(output, file);
  require_new_file(output, options.force, "the result");
  convert_file(file, output, options);
  print_written(output);
}

// Converts all snapshots of a run into a separate folder; the list for ParaView is written last.
void convert_run(const ConvertOptions& options) {
  const std::vector<fs::path> snapshots = runs::snapshots_in(options.path);
  const fs::path folder = options.output.value_or(fs::path(options.path) / options.format);
  require_folder_name(folder);
  const fs::path list = folder / "snapshots.pvd";
  const auto result_of = [&](const fs::path& snapshot) {
    return folder / snapshot.filename().replace_extension(options.table_format().ending);
  };
  files::require_writable_folder(files::folder_of(folder), folder);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error)
    throw IoError(fmt::format("cannot make the folder '{}': {}; name another", folder.string(), error.message()));
  for (const fs::path& snapshot : snapshots)
    require_new_file(result_of(snapshot), options.force, "the result");
  std::vector<io::VtpInstant> instants;
  for (const fs::path& snapshot : snapshots) {
    throw_if_interrupted();
    const fs::path result = result_of(snapshot);
    instants.push_back({convert_file(snapshot, result, options), result.filename().string()});
    if (options.format != "vtp")
      print("{}\n", result.string());
  }
  if (options.format == "vtp") {
    write_pvd(list, instants);
    print("{}\n", list.string());
  }
}

} // namespace

void add_convert(CLI::App& program, Action& action) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App& command = *program.add_subcommand("convert", "write particles for other programs");
  command
      .add_option("FILE|DIR", options->path,
                  "a snapshot, a checkpoint or a table of particles (CSV, HDF5, npz, extended XYZ, GADGET), or the "
                  "folder of a run: all its snapshots")
      ->required()
      ->type_name("");
  std::vector<std::string> names;
  std::string about;
  for (const io::TableFormat& format : io::table_formats()) {
    names.emplace_back(format.name);
    about += fmt::format("{}{}: {}", about.empty() ? "" : "; ", format.name, format.about);
  }
  one_of(command.add_option("--to", options->format, about), names).required();
  command
      .add_option("-o,--output", options->output,
                  "the file to write (default: the source's name with the new ending), or for a run the folder "
                  "(default: one named as the format, in the run's folder)")
      ->type_name("FILE|DIR");
  command.add_flag("--force", options->force, "replace files that exist");
  examples_of(command,
              {"keeler convert wakes --to vtp", "keeler convert wakes/snap_000030.hdf --to csv -o particles.csv",
               "keeler convert others.xyz --to npz"});
  command.callback([options, &action] {
    action = [options] {
      return unless_stopped("stopped before all was written (on request); the written files are complete", [&] {
        if (fs::is_directory(options->path))
          convert_run(*options);
        else
          convert_one(*options);
        return ExitCode::done;
      });
    };
  });
}

} // namespace keeler::cli
