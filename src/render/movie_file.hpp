// A movie file, written frame by frame. It gets its name when it is finished; a failure before that leaves no file.
#pragma once

#include "page.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>

namespace keeler {

class MovieFile {
public:
  MovieFile() = default;
  MovieFile(const MovieFile&) = delete;
  MovieFile& operator=(const MovieFile&) = delete;
  virtual ~MovieFile() = default;

  /// Appends a frame; all frames must have one size. Throws IoError.
  virtual void add(Page& page) = 0;
  /// Completes the file. Throws IoError.
  virtual void finish() = 0;
};

std::unique_ptr<MovieFile> new_mp4(const std::filesystem::path& file, int width, int height);
std::unique_ptr<MovieFile> new_animated_png(const std::filesystem::path& file, std::size_t frames);

/// Chooses the format by the extension of the name.
inline std::unique_ptr<MovieFile> new_movie(const std::filesystem::path& file, int width, int height,
                                            std::size_t frames) {
  return file.extension() == ".mp4" ? new_mp4(file, width, height) : new_animated_png(file, frames);
}

} // namespace keeler
