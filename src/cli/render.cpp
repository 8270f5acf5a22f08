// keeler render: pictures of a snapshot, or of the last state of a run.
#include "command.hpp"

#include <keeler/diagnostics/autocorrelation.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/wakes.hpp>
#include <keeler/render/autocorrelation_picture.hpp>
#include <keeler/render/patch_picture.hpp>
#include <keeler/runs/stored_patches.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace keeler {
namespace {

namespace fs = std::filesystem;

constexpr double averaged_orbits = 1.0;

struct RenderOptions {
  std::string path, output;
};

// picture.png in a run's folder, NAME.png beside a snapshot NAME.hdf.
fs::path picture_path(const RenderOptions& options) {
  if (!options.output.empty())
    return options.output;
  const fs::path path(options.path);
  return fs::is_directory(path) ? path / "picture.png" : fs::path(path).replace_extension(".png");
}

ExitCode render(const RenderOptions& options) {
  const StoredPatches stored = load_patches(options.path, averaged_orbits);
  const fs::path picture = picture_path(options);
  PictureOptions look;
  if (!stored.title.empty())
    look.title = stored.title;
  render_patch(stored.patches.back(), picture.string(), look);
  fmt::print("{}\n", picture.string());

  fs::path correlation = picture;
  correlation.replace_filename(picture.stem().string() + "-autocorrelation.png");
  const double wavelength = critical_wavelength(stored.patches.back());
  const AutocorrelationMap map = mean_autocorrelation(stored.patches);
  render_autocorrelation(map, find_wakes(map, wavelength), wavelength, correlation.string(), look.title);
  fmt::print("{}\n", correlation.string());
  return ExitCode::done;
}

} // namespace

void add_render(CLI::App& program, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App& command =
      *program.add_subcommand("render", "draw a snapshot, or the last state of a run, and its autocorrelation");
  command.add_option("FILE|DIR", options->path, "a snapshot, or the folder of a run")->required()->type_name("");
  command.add_option("-o,--output", options->output,
                     "the PNG to write (default: picture.png in the folder, or beside the file)");
  command.callback([options, &action] { action = [options] { return render(*options); }; });
}

} // namespace keeler
