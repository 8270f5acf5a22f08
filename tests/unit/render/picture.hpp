// Reads pictures back.
#pragma once

#include <cairo.h>
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace keeler::test {

/// A file name that is free for this test and is removed at the end.
class TemporaryPng {
public:
  explicit TemporaryPng(const std::string& name)
      : path_((std::filesystem::temp_directory_path() / ("keeler-" + std::to_string(getpid()) + "-" + name + ".png"))
                  .string()) {}
  TemporaryPng(const TemporaryPng&) = delete;
  TemporaryPng& operator=(const TemporaryPng&) = delete;
  ~TemporaryPng() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

class Picture {
public:
  explicit Picture(const std::string& path) : surface_(cairo_image_surface_create_from_png(path.c_str())) {
    REQUIRE(cairo_surface_status(surface_) == CAIRO_STATUS_SUCCESS);
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  ~Picture() { cairo_surface_destroy(surface_); }

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }

  /// Mean of red, green and blue, 0 to 255.
  double brightness(int x, int y) const { return (part(x, y, 0) + part(x, y, 8) + part(x, y, 16)) / 3.0; }

  /// Red less blue.
  double warmth(int x, int y) const { return part(x, y, 16) - part(x, y, 0); }

private:
  double part(int x, int y, int shift) const {
    const unsigned char* row = cairo_image_surface_get_data(surface_) +
                               static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_);
    return reinterpret_cast<const std::uint32_t*>(row)[x] >> shift & 0xff;
  }

  cairo_surface_t* surface_;
};

/// Bytes of a file.
inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

} // namespace keeler::test
