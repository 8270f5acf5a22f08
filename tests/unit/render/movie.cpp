#include <keeler/render/movie.hpp>

#include "picture.hpp"
#include "unit/diagnostics/states.hpp"

#include <keeler/core/error.hpp>

#include <filesystem>

#include <unistd.h>

namespace movie_test {

using namespace keeler;
using namespace keeler::render;

namespace {

// A free name for a movie, which is removed at the end.
class TemporaryMovie {
public:
  ~TemporaryMovie() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

private:
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("keeler-" + std::to_string(getpid()) + "-movie.mp4")).string();
};

// A cloud that gets thicker and drifts, frame by frame.
Patch frame(std::size_t k) {
  Patch patch = test::uniform({40.0, 30.0, 1.5, 0.0}, 7.0, 60, 1);
  for (Vec3& position : patch.positions)
    position.z() *= 1.0 + 2.0 * static_cast<double>(k);
  return patch;
}

PictureOptions small() {
  PictureOptions options;
  options.width = 300;
  options.colour = ColourField::speed;
  return options;
}

// Returns the height of a movie's pictures, from its track header (ISO/IEC 14496-12, 8.3.2).
int movie_height(const std::string& mp4) {
  const std::size_t height = mp4.find("tkhd") + 4 + 80; // 16.16, as its last field
  REQUIRE(height + 2 < mp4.size());
  return static_cast<unsigned char>(mp4[height]) << 8 | static_cast<unsigned char>(mp4[height + 1]);
}

} // namespace

TEST_CASE("a movie has one scale for all frames") {
  const TemporaryMovie movie;
  render_movie(3, frame, movie.path(), small());
  PictureOptions options = small();
  options.scale = picture_scale(frame(0), options.colour);
  for (const std::size_t k : {1u, 2u})
    options.scale->include(picture_scale(frame(k), options.colour));
  const int height = layout_of(frame(0), options).height;
  CHECK(movie_height(test::bytes_of(movie.path())) == height + height % 2);
  CHECK(layout_of(frame(0), small()).height < height); // alone it would be flatter
}

TEST_CASE("a movie that cannot be made leaves no file") {
  const TemporaryMovie movie;
  const auto breaks = [](std::size_t k) { return k < 2 ? frame(k) : throw IoError("no snapshot"); };
  CHECK_THROWS_AS(render_movie(3, breaks, movie.path(), small()), IoError);
  const auto grows = [](std::size_t k) {
    Patch patch = frame(0);
    patch.box.size_y += 5.0 * static_cast<double>(k);
    return patch;
  };
  CHECK_THROWS_WITH_AS(render_movie(2, grows, movie.path(), small()), doctest::Contains("the box changes"), UsageError);
  CHECK_THROWS_AS(render_movie(2, frame, "/nowhere/at/all.mp4", small()), IoError);
  CHECK_THROWS_WITH_AS(render_movie(2, frame, "movie.png", small()), doctest::Contains(".mp4"), UsageError);
  CHECK(!std::filesystem::exists(movie.path()));
}

} // namespace movie_test
