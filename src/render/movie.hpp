// A movie of a run: pictures at a common scale, as an MP4 by the program ffmpeg.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/render/patch_picture.hpp>

#include <cstddef>
#include <functional>
#include <string>

namespace keeler::render {

inline constexpr int movie_frames_per_second = 12;

/// Throws UsageError unless `path` ends in .mp4 and ffmpeg is installed.
void require_movie_name(const std::string& path);

/// Writes a movie of patch(0) … patch(count − 1). Each patch is requested twice: first for the common scale, so that
/// frame, height of the edge view and colours are constant. Throws as render_patch, UsageError as above or when the box
/// changes, Interrupted between two pictures (interrupt.hpp). A failure leaves no file.
void render_movie(std::size_t count, const std::function<Patch(std::size_t)>& patch, const std::string& path,
                  const PictureOptions& options, const std::function<void(const Progress&)>& progress = {});

} // namespace keeler::render
