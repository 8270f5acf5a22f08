#include <keeler/render/movie.hpp>

#include "mp4.hpp"
#include "patch_page.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <unistd.h>

namespace keeler::render {
namespace {

PictureScale common_scale(std::size_t count, const std::function<Patch(std::size_t)>& patch, ColourField field,
                          PhaseProgress& progress) {
  progress.begin("the common scale", static_cast<double>(count));
  std::optional<PictureScale> scale;
  for (std::size_t k = 0; k < count; ++k) {
    throw_if_interrupted();
    const Patch here = patch(k);
    progress.add(1.0);
    if (here.size() == 0)
      continue; // reported when it is drawn
    const PictureScale next = picture_scale(here, field);
    if (scale)
      scale->include(next);
    else
      scale = next;
  }
  return scale.value_or(PictureScale());
}

bool has_ffmpeg() {
  const char* const folders = std::getenv("PATH");
  std::istringstream path(folders ? folders : "");
  for (std::string folder; std::getline(path, folder, ':');) {
    const std::filesystem::path program = std::filesystem::path(folder.empty() ? "." : folder) / "ffmpeg";
    std::error_code unreadable;
    if (std::filesystem::is_regular_file(program, unreadable) && access(program.c_str(), X_OK) == 0)
      return true;
  }
  return false;
}

} // namespace

void require_movie_name(const std::string& path) {
  files::refuse_stream(path, "MP4");
  if (std::filesystem::path(path).extension() != ".mp4")
    throw UsageError(fmt::format("'{}' cannot be a movie: movies are .mp4 files; give it that ending", path));
  if (!has_ffmpeg())
    throw UsageError(
        fmt::format("'{}' cannot be made: the program ffmpeg is not on PATH; install the package ffmpeg", path));
}

void render_movie(std::size_t count, const std::function<Patch(std::size_t)>& patch, const std::string& path,
                  const PictureOptions& options, const std::function<void(const Progress&)>& report) {
  require_movie_name(path);
  PhaseProgress progress(report);
  PictureOptions look = options;
  if (!options.lit) // its scale is the same for all
    look.scale = common_scale(count, patch, options.colour, progress);
  progress.begin("pictures", static_cast<double>(count));
  std::unique_ptr<Mp4> movie;
  int width = 0, height = 0;
  for (std::size_t k = 0; k < count; ++k) {
    throw_if_interrupted();
    const std::unique_ptr<plot::Page> page = patch_page(patch(k), look);
    if (!movie) {
      width = page->width();
      height = page->height();
      movie = std::make_unique<Mp4>(path, width, height);
    }
    if (page->width() != width || page->height() != height)
      throw UsageError(fmt::format("no movie '{}': the box changes at picture {}; draw the parts of the run "
                                   "separately",
                                   path, k + 1));
    movie->add(*page);
    progress.add(1.0);
  }
  if (movie)
    movie->finish();
}

} // namespace keeler::render
