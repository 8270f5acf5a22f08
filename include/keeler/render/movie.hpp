// A movie of a run: its pictures at one scale, an MP4 by the program ffmpeg, or an animated PNG without it.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/render/patch_picture.hpp>

#include <cstddef>
#include <functional>
#include <string>

namespace keeler {

inline constexpr int movie_frames_a_second = 12;

/// Whether the program ffmpeg is on PATH.
bool has_ffmpeg();

/// Throws UsageError unless `path` ends in .png, or in .mp4 where there is ffmpeg.
void require_movie_name(const std::string& path);

/// Writes a movie of patch(0) … patch(count − 1), each asked for twice: first for the scale that all share. Frame,
/// height of the edge view and colours stay. Throws as render_patch, UsageError as above or when the box changes; a
/// failure leaves no file. Interrupted between two pictures when that is asked for (interrupt.hpp).
void render_movie(std::size_t count, const std::function<Patch(std::size_t)>& patch, const std::string& path,
                  const PictureOptions& options, const std::function<void(const Progress&)>& progress = {});

} // namespace keeler
