#include <keeler/render/movie.hpp>

#include "picture.hpp"
#include "unit/diagnostics/states.hpp"

#include <keeler/core/error.hpp>

#include <cstdlib>

namespace movie_test {

using namespace keeler;

namespace {

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

// Returns the number of chunks with a name.
std::size_t chunks(const std::string& png, const std::string& name) {
  std::size_t count = 0;
  for (std::size_t at = 8; at + 8 < png.size(); ++count) {
    std::size_t length = 0;
    for (std::size_t b = 0; b < 4; ++b)
      length = length << 8 | static_cast<unsigned char>(png[at + b]);
    count -= png.compare(at + 4, 4, name) != 0;
    at += 12 + length;
  }
  return count;
}

} // namespace

TEST_CASE("an animated PNG begins with the first frame at the scale of all") {
  const test::TemporaryPng movie("movie"), still("still");
  render_movie(3, frame, movie.path(), small());
  const std::string bytes = test::bytes_of(movie.path());
  CHECK(chunks(bytes, "acTL") == 1);
  CHECK(chunks(bytes, "fcTL") == 3);
  CHECK(chunks(bytes, "fdAT") >= 2);
  CHECK(chunks(bytes, "IEND") == 1);

  PictureOptions options = small();
  options.scale = picture_scale(frame(0), options.colour);
  for (const std::size_t k : {1u, 2u})
    options.scale->include(picture_scale(frame(k), options.colour));
  render_patch(frame(0), still.path(), options);
  const test::Picture first(movie.path()),
      expected(still.path()); // libpng checks the chunks, and shows the first frame
  REQUIRE(first.height() == expected.height());
  CHECK(layout_of(frame(0), small()).height < first.height()); // alone it would be flatter
  for (int y = 0; y < first.height(); ++y)
    for (int x = 0; x < first.width(); ++x)
      REQUIRE(first.brightness(x, y) == expected.brightness(x, y));
}

TEST_CASE("a movie that cannot be made leaves no file") {
  const test::TemporaryPng movie("no-movie");
  const auto breaks = [](std::size_t k) { return k < 2 ? frame(k) : throw IoError("no snapshot"); };
  CHECK_THROWS_AS(render_movie(3, breaks, movie.path(), small()), IoError);
  const auto grows = [](std::size_t k) {
    Patch patch = frame(0);
    patch.box.size_y += 5.0 * static_cast<double>(k);
    return patch;
  };
  CHECK_THROWS_WITH_AS(render_movie(2, grows, movie.path(), small()), doctest::Contains("the box changes"), UsageError);
  CHECK_THROWS_AS(render_movie(2, frame, "/nowhere/at/all.png", small()), IoError);
  CHECK_THROWS_WITH_AS(render_movie(2, frame, "movie.gif", small()), doctest::Contains(".mp4"), UsageError);
  CHECK(!std::filesystem::exists(movie.path()));
}

} // namespace movie_test
