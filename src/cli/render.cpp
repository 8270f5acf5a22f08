// keeler render: draws a snapshot, the last state of a run, or its series.
#include "command.hpp"
#include "common_options.hpp"
#include "light_options.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "signals.hpp"

#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/render/movie.hpp>
#include <keeler/render/patch_picture.hpp>
#include <keeler/run_report/series_figure.hpp>
#include <keeler/runs/stored_patches.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::optional<std::string> output;
  std::string path, colour = "height", theme = "dark";
  int width = render::PictureOptions().width;
  bool oblique = false, movie = false, series = false, lit = false;
  LitSight sight;
  LawOptions law{.name = "lambert", .albedo = 0.5};
};

constexpr std::string_view png_signature = "\x89PNG";

std::string_view signature_of(plot::PageFormat format) {
  return format == plot::PageFormat::png ? png_signature : format == plot::PageFormat::svg ? "<svg " : "%PDF-";
}

// Returns picture.png in a run's folder, or NAME.png beside a snapshot NAME.hdf.
fs::path picture_path(const RenderOptions& options) {
  if (options.output)
    return output_named(*options.output);
  const fs::path path(options.path);
  return output_beside(path, fs::is_directory(path) ? path / "picture.png" : fs::path(path).replace_extension(".png"));
}

render::PictureOptions picture_options(const RenderOptions& options) {
  render::PictureOptions picture;
  picture.width = options.width;
  picture.theme = options.theme == "light" ? render::PictureTheme::light : render::PictureTheme::dark;
  picture.colour = render::colour_field_named(options.colour);
  picture.oblique = options.oblique;
  if (options.lit) {
    light::require_tracer();
    picture.lit = render::LitLook{options.sight.sight(), options.law.law(),
                                  fmt::format("{}, albedo {}", options.law.name, format_number(options.law.albedo)),
                                  options.sight.samples};
  }
  return picture;
}

ExitCode draw_movie(const RenderOptions& options) {
  if (!fs::is_directory(options.path))
    throw UsageError(fmt::format("no movie of '{}': it is not a folder; name the folder of a run", options.path));
  const fs::path movie = options.output ? output_named(*options.output) : fs::path(options.path) / "movie.mp4";
  render::require_movie_name(movie.string());
  require_replaceable(movie, "a movie", "ftyp", 4);
  const std::vector<fs::path> snapshots = runs::snapshots_in(options.path);
  render::PictureOptions picture = picture_options(options);
  if (const std::string title = runs::load_newest_patch(snapshots.front()).title; !title.empty())
    picture.title = title;
  const auto patch = [&](std::size_t k) { return runs::load_newest_patch(snapshots[k]).patches.back(); };
  {
    ProgressLine line;
    render_movie(snapshots.size(), patch, movie.string(), picture,
                 [&line](const Progress& progress) { line.show_if_long(progress); });
  }
  print_written(movie);
  return ExitCode::done;
}

ExitCode draw_series(const RenderOptions& options) {
  if (!fs::is_directory(options.path))
    throw UsageError(fmt::format("no plots of '{}': it is not a folder; name the folder of a run", options.path));
  const fs::path figure = options.output ? output_named(*options.output) : fs::path(options.path) / "series.svg";
  const std::optional<plot::PageFormat> format =
      files::is_stream(figure) ? plot::PageFormat::svg : plot::page_format(figure);
  if (!format)
    throw UsageError(
        fmt::format("'{}' cannot be the plots: they are an .svg, .png or .pdf file; give it one of these endings",
                    figure.string()));
  require_replaceable(figure, "the plots", signature_of(*format));
  const plot::Figure plots = run_report::run_series_figure(options.path, options.theme == "light");
  files::write_file(figure, figure_bytes(plots, *format, static_cast<double>(options.width) / plots.width));
  print_written(figure);
  return ExitCode::done;
}

ExitCode render(const RenderOptions& options) {
  if (options.series)
    return draw_series(options);
  render::PictureOptions drawing = picture_options(options);
  if (options.movie)
    return draw_movie(options);
  const fs::path picture = picture_path(options);
  const runs::StoredPatches stored = runs::load_newest_patch(options.path);
  if (!files::is_stream(picture) && picture.extension() != ".png")
    throw UsageError(
        fmt::format("'{}' cannot be a picture: pictures are .png files; give it that ending", picture.string()));
  require_replaceable(picture, "a picture", png_signature);
  if (!stored.title.empty())
    drawing.title = stored.title;
  render_patch(stored.patches.back(), picture.string(), drawing);
  print_written(picture);
  return ExitCode::done;
}

} // namespace

void add_render(CLI::App& program, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App& command = *program.add_subcommand("render", "draw a snapshot, or the last state of a run");
  command.add_option("FILE|DIR", options->path, "a snapshot, or the folder of a run")->required()->type_name("");
  command
      .add_option("-o,--output", options->output,
                  "the file to write (default: picture.png in the folder, or beside the file)")
      ->type_name("FILE");
  command.add_option("--width", options->width, "width of the picture (default: 1600)")
      ->type_name("PIXELS")
      ->transform(whole_number_between(render::min_picture_width, render::max_picture_width, "a number of pixels"));
  one_of(command.add_option("--theme", options->theme, "background: dark (the default), or light for print"),
         {"dark", "light"});
  CLI::Option* const colour =
      command
          .add_option("--colour", options->colour,
                      "quantity shown by colours, with a colour bar (default: height, shades without a bar)")
          ->type_name(fmt::format("{}", fmt::join(render::colour_field_names(), "|")));
  CLI::Option* const oblique = command.add_flag("--oblique", options->oblique,
                                                "view the patch from 35 degrees above its plane instead of from above");
  CLI::Option* const movie = command.add_flag(
      "--movie", options->movie, "draw all snapshots of a run at one scale: movie.mp4, by the program ffmpeg");
  CLI::Option* const lit =
      command
          .add_flag("--lit", options->lit,
                    "draw what an observer sees in sunlight: shadows, and light scattered more than once")
          ->excludes(colour)
          ->excludes(oblique);
  options->sight.add_to(command, lit);
  options->law.add_to(command, lit);
  command
      .add_flag(
          "--series", options->series,
          "draw the series of a run instead of its particles: series.svg (or .png, .pdf), one plot per quantity, with "
          "errors")
      ->excludes(movie)
      ->excludes(colour)
      ->excludes(oblique)
      ->excludes(lit);
  examples_of(command, {"keeler render wakes --oblique --colour speed",
                        "keeler render wakes --theme light --width 2000 -o figure.png", "keeler render wakes --movie",
                        "keeler render wakes --series --theme light -o series.svg",
                        "keeler render wakes --lit --elevation 15 --azimuth -70 --phase 60 -o lit.png",
                        "keeler render wakes --lit --elevation 30 --law callisto --movie"});
  command.callback([options, &action] {
    action = [options] {
      return unless_stopped("stopped before all was drawn (on request); no part of a picture or a movie is left",
                            [&] { return render(*options); });
    };
  });
}

} // namespace keeler::cli
