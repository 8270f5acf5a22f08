// The file of a movie, filled frame by frame. It takes its name when it is finished; a failure before leaves nothing.
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

  /// Throws IoError.
  virtual void add(Page& page) = 0;
  virtual void finish() = 0;
};

std::unique_ptr<MovieFile> new_mp4(const std::filesystem::path& file, int width, int height);
std::unique_ptr<MovieFile> new_animated_png(const std::filesystem::path& file, std::size_t frames);

/// By the ending of the name.
inline std::unique_ptr<MovieFile> new_movie(const std::filesystem::path& file, int width, int height,
                                            std::size_t frames) {
  return file.extension() == ".mp4" ? new_mp4(file, width, height) : new_animated_png(file, frames);
}

} // namespace keeler
